#include <varifold/models/vdpm/build.h>

#include <varifold/models/vdpm/assemble.h>
#include <varifold/models/vdpm/shape_bounds.h>
#include <utility>

namespace varifold {

ViewDependentMesh build_view_dependent_mesh(const DetailedMesh& detailed,
                                            const StepBoundsOptions& options) {
  ViewDependentMeshData data;
  std::vector<std::uint32_t> parents;
  std::vector<StepBounds> bounds;
  const SequenceHistory history(detailed);
  {
    const StepGraph graph(detailed, history, options.threads);
    parents = watch_parents(graph);
    data = assemble_steps(detailed, history, graph, parents);
  }
  if (!measure_step_bounds(detailed, parents, options, bounds, &history)) return {};
  data.mesh = detailed.mesh;
  data.mesh.indices = {};
  data.levels = LevelTable(detailed.sequence);
  if (detailed.has_shapes()) data.centers = shape_centers(detailed);
  data.bounds.reserve(bounds.size());
  for (const StepBounds& b : bounds)
    data.bounds.push_back(
        {b.cone, b.radius, b.nested_radius, b.mu, b.delta, b.nested_error, b.nested_angle});
  return ViewDependentMesh(std::move(data));
}

}  // namespace varifold
