// The surface that is cut into patches: triangles over position classes, and nothing else.
#pragma once

#include <varifold/base/math.h>
#include <cstddef>
#include <cstdint>
#include <span>

namespace varifold {

/// A view of triangles over points; owns nothing. Every triangle has three different corners, each
/// below positions.size(). Edges may have any number of triangles in any orientation. Neighbours in
/// space should be neighbours in number (a Morton curve), or all is slower.
struct SurfaceView {
  std::span<const std::uint32_t> corners;    ///< three per triangle, indices of `positions`
  std::span<const Vec3> positions;           ///< one per position class
  std::span<const std::uint32_t> materials;  ///< one per triangle, or empty: all of one material

  [[nodiscard]] std::uint32_t triangle_count() const {
    return static_cast<std::uint32_t>(corners.size() / 3);
  }
  [[nodiscard]] std::uint32_t material_of(std::uint32_t triangle) const {
    return materials.empty() ? 0 : materials[triangle];
  }
};

/// Half-edge 3 t + e runs from corner e of triangle t to its corner (e + 1) % 3.
[[nodiscard]] inline std::uint32_t next_in_triangle(std::uint32_t half_edge) {
  return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
}

}  // namespace varifold
