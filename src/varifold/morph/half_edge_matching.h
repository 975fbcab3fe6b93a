// What hangs together in a mesh that may be no surface yet. Internal to this folder.
#pragma once

#include <varifold/base/math.h>
#include <varifold/mesh/weld.h>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace varifold {

/// The triangles with three places, one for each set of them and side, ascending. Two back to back
/// stay both: as a rule they are parts of two sheets that touch, and a handle would join these
/// without them. O(n log n).
[[nodiscard]] std::vector<std::uint32_t> distinct_triangles(std::span<const std::uint32_t> indices,
                                                            const WeldMap& weld);

/// Per half-edge (3 t + k, from corner k of triangle t) the one that runs the other way in the
/// triangle beside it; kNone at holes. `classes` are the points of the corners. Where an edge has
/// more than two triangles, pairs of the most equal normals come first; such edges are counted
/// in `crowded_edges`. O(n log n).
[[nodiscard]] std::vector<std::uint32_t> match_half_edges(
    std::span<const std::uint32_t> classes,
    const std::function<Vec3(std::uint32_t triangle)>& normal_of, std::uint32_t& crowded_edges);

}  // namespace varifold
