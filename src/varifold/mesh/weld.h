// Position classes: vertices at one place are one point of the surface, whatever their attributes.
#pragma once

#include <varifold/base/math.h>
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

/// Vertices are welded when a chain of vertices joins them whose links are not longer than
/// `tolerance` (>= 0, model units). O(n) expected while few vertices share a cell of that size.
[[nodiscard]] WeldMap weld_within(std::span<const Vec3> positions, float tolerance);

}  // namespace varifold
