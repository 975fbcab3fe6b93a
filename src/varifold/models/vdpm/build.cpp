#include <varifold/models/vdpm/build.h>

#include <varifold/models/vdpm/assemble.h>
#include <utility>

namespace varifold {

ViewDependentMesh build_view_dependent_mesh(const DetailedMesh& detailed,
                                            const StepBoundsOptions& options) {
  const StepGraph graph(detailed);
  std::vector<StepBounds> bounds;
  if (!measure_step_bounds(detailed, watch_parents(graph), options, bounds)) return {};
  ViewDependentMeshData data = assemble_steps(detailed, graph);
  data.bounds.reserve(bounds.size());
  for (const StepBounds& b : bounds)
    data.bounds.push_back(
        {b.cone, b.radius, b.nested_radius, b.mu, b.delta, b.nested_error, b.nested_angle});
  return ViewDependentMesh(std::move(data));
}

}  // namespace varifold
