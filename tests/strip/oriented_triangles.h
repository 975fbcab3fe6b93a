// Sets of triangles that can be compared.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace varifold::test {

/// Corners in their order from the least one on, and the material.
using OrientedTriangle = std::array<std::uint32_t, 4>;

[[nodiscard]] inline OrientedTriangle oriented(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                                               std::uint32_t material) {
  if (b < a && b <= c) return {b, c, a, material};
  if (c < a && c < b) return {c, a, b, material};
  return {a, b, c, material};
}

/// All triangles of a mesh that have three different corners, sorted.
[[nodiscard]] inline std::vector<OrientedTriangle> oriented_triangles(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> materials = triangle_materials(mesh);
  std::vector<OrientedTriangle> triangles;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::uint32_t a = mesh.indices[3 * t], b = mesh.indices[3 * t + 1],
                        c = mesh.indices[3 * t + 2];
    if (a != b && b != c && c != a) triangles.push_back(oriented(a, b, c, materials[t]));
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace varifold::test
