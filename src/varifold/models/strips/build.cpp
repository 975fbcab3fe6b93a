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
