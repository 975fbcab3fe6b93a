// Multiresolution strips of all test meshes.
#pragma once

#include <tests/models/level_checks.h>
#include <tests/support/greedy_strips.h>
#include <tests/support/meshes.h>

#include <varifold/models/mts/build.h>
#include <varifold/models/mts/instance.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace varifold::test {

/// The triangles of greedy_strips() with one strip per material range, its parts joined by
/// degenerate triangles.
inline TriangleStrips long_strips(const TriangleMesh& mesh) {
  const TriangleStrips strips = greedy_strips(mesh);
  TriangleStrips joined;
  std::uint32_t range_count = 0;
  for (const std::uint32_t r : strips.range) range_count = std::max(range_count, r + 1);
  for (std::uint32_t r = 0; r < range_count; ++r) {
    const std::size_t begin = joined.indices.size();
    for (std::uint32_t s = 0; s < strips.count(); ++s) {
      if (strips.range[s] != r) continue;
      const auto strip = strips.strip(s);
      if (joined.indices.size() > begin) {
        joined.indices.push_back(joined.indices.back());
        if ((joined.indices.size() - begin) % 2 == 0) joined.indices.push_back(strip[0]);
        joined.indices.push_back(strip[0]);
      }
      joined.indices.insert(joined.indices.end(), strip.begin(), strip.end());
    }
    joined.end_strip(r);
  }
  return joined;
}

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
