// Progressive meshes of all test meshes, and what it means that two are the same.
#pragma once

#include <tests/support/meshes.h>

#include <varifold/models/pm/build.h>
#include <varifold/models/pm/instance.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace varifold::test {

struct NamedModel {
  std::string name;
  DetailedMesh detailed;
  std::shared_ptr<const ProgressiveMesh> model;
};

inline NamedModel make_model(const NamedMesh& named, Placement placement) {
  SimplifyOptions options;
  options.placement = placement;
  options.threads = 1;
  NamedModel result;
  result.name = named.name + (placement == Placement::kOptimal ? "/optimal" : "");
  result.detailed = std::move(simplify(named.mesh, options)->detailed);
  result.model = std::make_shared<ProgressiveMesh>(build_progressive_mesh(result.detailed));
  return result;
}

/// Every test mesh, with kept and with optimal placement; made once.
inline const std::vector<NamedModel>& all_models() {
  static const std::vector<NamedModel> models = [] {
    std::vector<NamedModel> made;
    for (const NamedMesh& named : all_groups())
      for (const Placement placement : {Placement::kKept, Placement::kOptimal})
        made.push_back(make_model(named, placement));
    return made;
  }();
  return models;
}

/// Those with at most so many levels.
inline std::vector<const NamedModel*> small_models(std::uint32_t levels) {
  std::vector<const NamedModel*> small;
  for (const NamedModel& model : all_models())
    if (model.model->finest_level() <= levels) small.push_back(&model);
  return small;
}

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

/// Empty where the models are the same byte for byte, else the first part that differs.
inline std::string difference(const ProgressiveMeshData& a, const ProgressiveMeshData& b) {
  if (!same_attributes(a.mesh, b.mesh)) return "attributes";
  if (a.mesh.indices != b.mesh.indices) return "indices";
  if (a.mesh.ranges != b.mesh.ranges) return "ranges";
  if (!same_materials(a.mesh, b.mesh)) return "materials";
  if (a.base_vertices != b.base_vertices || a.base_triangles != b.base_triangles) return "base";
  const auto same_split = [](const VertexSplit& x, const VertexSplit& y) {
    return x.slots == y.slots && x.vertices == y.vertices && x.triangles == y.triangles;
  };
  if (!std::equal(a.splits.begin(), a.splits.end(), b.splits.begin(), b.splits.end(), same_split))
    return "splits";
  if (a.slots != b.slots) return "slots";
  if (a.target != b.target) return "target";
  if (a.triangle_level != b.triangle_level) return "triangle_level";
  if (a.error != b.error || a.error_is_measured != b.error_is_measured) return "error";
  if (a.first_placed != b.first_placed) return "first_placed";
  if (a.placed_vertex != b.placed_vertex) return "placed_vertex";
  if (a.finer != b.finer) return "finer";
  if (!same_attributes(a.placed, b.placed)) return "placed";
  return {};
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

inline TriangleMesh level_mesh(const NamedModel& named, std::uint32_t level) {
  ProgressiveMeshInstance instance(named.model);
  instance.go_to_level(level);
  return instance.extract();
}

}  // namespace varifold::test
