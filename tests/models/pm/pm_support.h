// Progressive meshes of all test meshes, and what it means that two are the same.
#pragma once

#include <tests/models/level_checks.h>
#include <tests/support/meshes.h>

#include <varifold/models/pm/build.h>
#include <varifold/models/pm/instance.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
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

inline TriangleMesh level_mesh(const NamedModel& named, std::uint32_t level) {
  ProgressiveMeshInstance instance(named.model);
  instance.go_to_level(level);
  return instance.extract();
}

}  // namespace varifold::test
