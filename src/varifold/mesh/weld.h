// Position classes: vertices at one place are one point of the surface, whatever their attributes.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Maps every vertex to its position class. Classes are numbered in the order of their first
/// vertex, so the map of a mesh without seams is the identity.
struct WeldMap {
  std::vector<std::uint32_t> class_of;  ///< one entry per vertex
  std::uint32_t class_count = 0;
};

/// Vertices are welded when their positions are equal; -0 equals 0. O(n) expected.
[[nodiscard]] WeldMap weld_exact(std::span<const Vec3> positions);

/// The points of a mesh: vertices are welded when their positions are equal at rest and in every
/// pose, and they follow the same joints by the same weights, so that nothing can part them.
/// Lips that touch at rest and open in a pose stay apart. O(n) expected for each pose.
[[nodiscard]] WeldMap weld_points(const TriangleMesh& mesh);

/// Welded are the vertices that both maps weld. O(n) expected.
[[nodiscard]] WeldMap welded_by_both(const WeldMap& a, const WeldMap& b);

/// Vertices are welded when a chain of vertices joins them whose links are not longer than
/// `tolerance` (>= 0, model units). O(n) expected while few vertices share a cell of that size.
[[nodiscard]] WeldMap weld_within(std::span<const Vec3> positions, float tolerance);

}  // namespace varifold
