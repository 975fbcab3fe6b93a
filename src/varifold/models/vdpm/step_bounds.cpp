#include <varifold/models/vdpm/step_bounds.h>

#include <varifold/models/common/error_code.h>
#include <varifold/simplify/deviation.h>
#include <varifold/simplify/sequence_replay.h>
#include <varifold/view/cone_code.h>
#include <algorithm>
#include <cmath>

namespace varifold {

namespace {

// Distances in double, and what floats lose on the way.
constexpr double kRounding = 1 + 1e-6;

std::uint16_t length_code(double length) {
  return static_cast<std::uint16_t>(error_code(static_cast<float>(length * kRounding)));
}

double distance(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b) {
  return glm::length(DVec3(mesh.positions[a]) - DVec3(mesh.positions[b]));
}

}  // namespace

bool measure_step_bounds(const DetailedMesh& detailed, const StepGraph& /*graph*/,
                         std::span<const std::uint32_t> watch_parent,
                         const StepBoundsOptions& options, std::vector<StepBounds>& bounds) {
  const CollapseSequence& sequence = detailed.sequence;
  const std::uint32_t steps = sequence.step_count();
  const std::vector<float> deviations =
      step_deviations(detailed, {options.threads, options.progress});
  if (deviations.size() != steps) return false;
  bounds.assign(steps, {});
  std::vector<double> nested(steps, 0);
  std::vector<float> error = deviations;
  SequenceReplay replay(detailed);
  std::vector<std::uint32_t> slots;
  double moved = 0;  // how far vertices are from where they are at full detail, at most
  for (std::uint32_t j = 0; j < sequence.placed_vertex.size(); ++j)
    moved = std::max<double>(
        moved, glm::length(DVec3(sequence.placed.positions[j]) -
                           DVec3(detailed.mesh.positions[sequence.placed_vertex[j]])));
  for (std::uint32_t k = steps; k-- > 0;) {
    const std::uint32_t center = sequence.vertices[k];
    slots.clear();
    for (std::uint32_t v = center; v < sequence.vertices[k + 1]; ++v) replay.slots_of(v, slots);
    if (sequence.moves_vertices())
      for (std::uint32_t j = sequence.first_placed[k]; j < sequence.first_placed[k + 1]; ++j)
        replay.slots_of(sequence.placed_vertex[j], slots);
    double reach = distance(detailed.mesh, center, sequence.target[center]);
    for (const std::uint32_t slot : slots)
      for (std::uint32_t c = 0; c < 3; ++c)
        reach =
            std::max(reach, distance(detailed.mesh, center, replay.corners()[slot / 3 * 3 + c]));
    reach += moved;
    replay.collapse();
    nested[k] = std::max(nested[k], reach);
    bounds[k] = {center,
                 kWideConeCode,
                 length_code(reach),
                 length_code(nested[k]),
                 length_code(deviations[k]),
                 0,
                 length_code(error[k]),
                 StepBounds::kWide};
    if (watch_parent[k] == kNone) continue;
    const std::uint32_t parent = watch_parent[k];
    nested[parent] =
        std::max(nested[parent], nested[k] * kRounding +
                                     distance(detailed.mesh, center, sequence.vertices[parent]));
    error[parent] = std::max(error[parent], error[k]);
  }
  return true;
}

}  // namespace varifold
