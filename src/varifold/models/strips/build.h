// From a numbered mesh and its strips to the strips framework.
#pragma once

#include <varifold/models/strips/strip_framework.h>
#include <varifold/simplify/collapse_sequence.h>
#include <varifold/strip/triangle_strips.h>
#include <vector>

namespace varifold {

/// `full_strips` must draw each triangle of the full mesh once, in its orientation, and no other;
/// any stripifier will do. The sequence must not move vertices (kept placement): strips name
/// vertices, they do not move them. O(n log n): measures the error of every step.
[[nodiscard]] StripFramework build_strip_framework(const DetailedMesh& detailed,
                                                   const TriangleStrips& full_strips);

}  // namespace varifold
