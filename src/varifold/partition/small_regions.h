// Parts of a surface that are too small for a patch share one with others nearby.
#pragma once

#include <varifold/partition/triangle_groups.h>

namespace varifold {

/// Finds the regions (triangles linked by edges, or by `glued`, within a material) with fewer than
/// `triangles_per_patch` / 2 triangles, and packs those of one material, along a Morton curve of
/// the centres of their boxes, into groups of at most `triangles_per_patch`. Groups are numbered in
/// the order of their first triangle. O(n).
[[nodiscard]] TriangleGroups group_small_regions(const SurfaceView& surface, const EdgeLinks& links,
                                                 const TriangleGroups& glued,
                                                 std::uint32_t triangles_per_patch);

/// The Morton code (21 bits an axis) of a point in a box; 0 in an empty box.
[[nodiscard]] std::uint64_t morton_code(const Vec3& point, const Box& box);

}  // namespace varifold
