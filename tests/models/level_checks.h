// What it means that two levels are the same, whatever model they come from.
#pragma once

#include <gtest/gtest.h>

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/draw_list.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace varifold::test {

/// All levels of a small model, some 40 of a large one, the ends among them.
inline std::vector<std::uint32_t> spread_levels(std::uint32_t finest) {
  std::vector<std::uint32_t> levels;
  const std::uint32_t count = std::min(finest, finest <= 100 ? finest : 40u);
  for (std::uint32_t i = 0; i <= count; ++i)
    levels.push_back(count == 0 ? 0
                                : static_cast<std::uint32_t>(std::uint64_t{finest} * i / count));
  return levels;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline bool same_attributes(const TriangleMesh& a, const TriangleMesh& b) {
  return same_bytes(a.positions, b.positions) && same_bytes(a.normals, b.normals) &&
         same_bytes(a.texcoords, b.texcoords) && same_bytes(a.colors, b.colors);
}

inline bool same_materials(const TriangleMesh& a, const TriangleMesh& b) {
  const auto same_material = [](const Material& x, const Material& y) {
    return x.name == y.name && x.base_color == y.base_color && x.emissive == y.emissive &&
           x.metallic == y.metallic && x.roughness == y.roughness &&
           x.double_sided == y.double_sided && x.alpha_mode == y.alpha_mode &&
           x.alpha_cutoff == y.alpha_cutoff && x.textures == y.textures;
  };
  const auto same_image = [](const Image& x, const Image& y) {
    return x.name == y.name && x.mime_type == y.mime_type && x.uri == y.uri && x.bytes == y.bytes;
  };
  return std::equal(a.materials.begin(), a.materials.end(), b.materials.begin(), b.materials.end(),
                    same_material) &&
         std::equal(a.images.begin(), a.images.end(), b.images.begin(), b.images.end(), same_image);
}

/// Triangles with their materials, each turned so that its least corner comes first, sorted.
inline std::vector<std::array<std::uint32_t, 4>> triangle_set(const TriangleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 4>> triangles;
  const std::vector<std::uint32_t> materials = triangle_materials(mesh);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    std::array<std::uint32_t, 4> triangle{mesh.indices[3 * t], mesh.indices[3 * t + 1],
                                          mesh.indices[3 * t + 2], materials[t]};
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.begin() + 3),
                triangle.begin() + 3);
    triangles.push_back(triangle);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// Empty where the meshes have the same attributes, materials and set of triangles.
inline std::string mesh_difference(const TriangleMesh& a, const TriangleMesh& b) {
  if (!same_attributes(a, b)) return "attributes";
  if (!same_materials(a, b)) return "materials";
  if (triangle_set(a) != triangle_set(b)) return "triangles";
  return {};
}

/// A copy of what a reader would have on its device, kept up by the changed ranges alone.
struct DeviceCopy {
  std::vector<std::uint32_t> indices;
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;

  template <class T>
  static void upload(std::span<const T> from, std::span<const ElementRange> ranges,
                     std::vector<T>& to) {
    const std::size_t known = to.size();
    to.resize(from.size());
    std::copy(from.begin() + static_cast<std::ptrdiff_t>(std::min(known, from.size())), from.end(),
              to.begin() + static_cast<std::ptrdiff_t>(std::min(known, from.size())));
    for (const ElementRange& range : ranges) {
      ASSERT_LE(std::size_t{range.first} + range.count, from.size());
      std::copy_n(from.begin() + range.first, range.count, to.begin() + range.first);
    }
  }
  void take(const DrawList& list) {
    upload(list.indices, list.changed_indices, indices);
    upload(list.positions, list.changed_vertices, positions);
    if (!list.normals.empty()) upload(list.normals, list.changed_vertices, normals);
  }
  void expect_same(const DrawList& list, const std::string& where) const {
    EXPECT_TRUE(std::equal(indices.begin(), indices.end(), list.indices.begin())) << where;
    if (list.positions.empty()) return;
    EXPECT_EQ(std::memcmp(positions.data(), list.positions.data(), list.positions.size_bytes()), 0)
        << where;
    if (!list.normals.empty()) {
      EXPECT_EQ(std::memcmp(normals.data(), list.normals.data(), list.normals.size_bytes()), 0)
          << where;
    }
  }
};

}  // namespace varifold::test
