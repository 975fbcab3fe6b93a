// Multiresolution strips of all test meshes.
#pragma once

#include <tests/models/level_checks.h>
#include <tests/support/greedy_strips.h>
#include <tests/support/meshes.h>

#include <varifold/models/mts/build.h>
#include <varifold/models/mts/instance.h>
#include <varifold/simplify/simplify.h>
#include <memory>
#include <string>
#include <vector>

namespace varifold::test {

struct NamedMts {
  std::string name;
  DetailedMesh detailed;
  std::shared_ptr<const MultiresolutionStrips> model;
};

inline NamedMts make_mts(const NamedMesh& named, bool long_ones, const MtsOptions& options = {}) {
  NamedMts result;
  result.name = named.name + (long_ones ? "/long" : "");
  result.detailed = std::move(simplify(named.mesh, {.threads = 1})->detailed);
  const TriangleMesh& mesh = result.detailed.mesh;
  const TriangleStrips strips = long_ones ? long_strips(mesh) : greedy_strips(mesh);
  result.model =
      std::make_shared<MultiresolutionStrips>(build_mts(result.detailed, strips, options));
  return result;
}

/// Every test mesh, with short strips, with long ones full of degenerate joints, and with graphs
/// that end early; made once.
inline const std::vector<NamedMts>& all_mts() {
  static const std::vector<NamedMts> models = [] {
    std::vector<NamedMts> made;
    for (const NamedMesh& named : all_groups()) {
      made.push_back(make_mts(named, false));
      made.push_back(make_mts(named, true, {.longest_strip = 64}));
      made.push_back(make_mts(named, false, {.largest_graph = 60}));
      made.back().name += "/short_lived";
    }
    return made;
  }();
  return models;
}

}  // namespace varifold::test
