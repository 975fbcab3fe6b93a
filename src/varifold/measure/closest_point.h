// The point of a segment or triangle that is closest to another point, in double precision.
#pragma once

#include <varifold/base/math.h>

namespace varifold {

/// The closest point of the segment from a to b; a where both are one point.
[[nodiscard]] DVec3 closest_on_segment(const DVec3& p, const DVec3& a, const DVec3& b);

/// The closest point of the triangle. Any triangle: a degenerate one is the union of its edges.
[[nodiscard]] DVec3 closest_on_triangle(const DVec3& p, const DVec3& a, const DVec3& b,
                                        const DVec3& c);

}  // namespace varifold
