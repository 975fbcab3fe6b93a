#include <varifold/models/strips/build.h>

#include <varifold/models/common/step_graph.h>
#include <varifold/models/strips/build_regions.h>
#include <varifold/models/strips/dependencies.h>
#include <varifold/models/strips/strip_levels.h>
#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

namespace varifold {

namespace {

TriangleStrips sorted_by_range(const TriangleStrips& strips) {
  if (std::is_sorted(strips.range.begin(), strips.range.end())) return strips;
  std::vector<std::uint32_t> order(strips.count());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return strips.range[a] < strips.range[b];
  });
  TriangleStrips sorted;
  sorted.indices.reserve(strips.indices.size());
  for (const std::uint32_t s : order) {
    const auto strip = strips.strip(s);
    sorted.indices.insert(sorted.indices.end(), strip.begin(), strip.end());
    sorted.end_strip(strips.range[s]);
  }
  return sorted;
}

}  // namespace

StripFramework build_strip_framework(const DetailedMesh& detailed,
                                     const TriangleStrips& full_strips) {
  assert(!detailed.sequence.moves_vertices());
  StripFrameworkData data;
  data.levels = LevelTable(detailed.sequence);
  const StepGraph graph(detailed);
  data.dependencies = packed_dependencies(graph);
  measure_regions(detailed, graph, data);
  data.mesh = detailed.mesh;
  data.mesh.indices = {};
  TriangleStrips strips = sorted_by_range(full_strips);
  data.slivers = strip_levels(data.mesh, data.levels, strips).slivers;
  return {std::move(data), std::move(strips)};
}

}  // namespace varifold
