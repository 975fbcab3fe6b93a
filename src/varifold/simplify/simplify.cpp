#include <varifold/simplify/simplify.h>

#include <varifold/mesh/vertex_arrays.h>
#include <varifold/simplify/collapse_rounds.h>
#include <varifold/simplify/deviation.h>
#include <varifold/simplify/energy_collapser.h>
#include <varifold/simplify/input_fault.h>
#include <varifold/simplify/placement_collapser.h>
#include <varifold/simplify/pose_field.h>
#include <varifold/simplify/sequence_builder.h>
#include <varifold/simplify/stop_report.h>
#include <algorithm>
#include <chrono>
#include <cmath>

namespace varifold {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The number of steps after which the mesh has at most `target` faces.
std::size_t steps_to_target(const CollapseLog& log, std::uint32_t faces, std::uint32_t target) {
  std::size_t steps = 0;
  while (steps < log.entries.size() && faces > target) faces -= log.entries[steps++].removed_faces;
  return steps;
}

std::vector<Pose> gather_samples(std::span<const Pose> samples,
                                 const std::vector<std::uint32_t>& original_vertex) {
  std::vector<Pose> gathered;
  for (const Pose& sample : samples) {
    Pose& pose = gathered.emplace_back();
    pose.name = sample.name;
    pose.positions.reserve(original_vertex.size());
    for (const std::uint32_t v : original_vertex) pose.positions.push_back(sample.positions[v]);
  }
  return gathered;
}

// What the options ask for and poses stand in the way of; empty where nothing does.
std::string pose_conflict(const TriangleMesh& mesh, const SimplifyOptions& options) {
  if (mesh.poses.empty() && options.poses.samples.empty() && !mesh.has_skin()) return {};
  if (options.placement == Placement::kOptimal)
    return "vertices of a mesh with poses or a skin must stay where they are (placement kept)";
  if (options.metric == Metric::kEnergy)
    return "energy is not defined for several poses (metric quadric)";
  return {};
}

CollapseLog run_kept(WorkingSurface& surface, Collapser& collapser,
                     const SimplifyOptions& options) {
  RoundOptions rounds;
  rounds.target_faces = options.target_triangles;
  rounds.threads = options.threads;
  rounds.progress = options.progress;
  return run_rounds(surface, collapser, rounds);
}

CollapseLog run_placed(const PlacementInput& input, const SimplifyOptions& options,
                       PlacementLog& placement) {
  PlacementOptions placement_options;
  placement_options.legality = options.legality;
  placement_options.target_faces = options.target_triangles;
  placement_options.progress = options.progress;
  return collapse_with_placement(input, placement_options, placement);
}

CollapseLog run_energy(const EnergyInput& input, const SimplifyOptions& options,
                       PlacementLog* placement) {
  EnergyCollapseOptions energy_options;
  energy_options.energy = options.energy;
  energy_options.legality = options.legality;
  energy_options.target_faces = options.target_triangles;
  energy_options.threads = options.threads;
  energy_options.progress = options.progress;
  return std::move(collapse_by_energy(input, energy_options, placement).log);
}

}  // namespace

Result<Simplification> simplify(const TriangleMesh& mesh, const SimplifyOptions& options) {
  std::string fault = input_fault(mesh);
  if (fault.empty()) fault = sample_fault(mesh, options.poses.samples);
  if (!fault.empty()) return fail(ErrorKind::kInvalidInput, std::move(fault));
  if (std::string conflict = pose_conflict(mesh, options); !conflict.empty())
    return fail(ErrorKind::kUnsupported, std::move(conflict));
  const auto start = Clock::now();
  Simplification result;

  // Build the working surface.
  SurfaceOptions surface_options;
  surface_options.with_wedges = may_have_seams(mesh);
  surface_options.threads = options.threads;
  WorkingSurface surface = build_surface(mesh, surface_options, result.faults);
  const std::uint32_t all_faces = surface.face_count;
  const bool placed = options.placement == Placement::kOptimal;
  AttributeField attributes;
  if (surface_options.with_wedges)
    attributes = AttributeField(mesh, surface.wedge.vertex_of, options.attributes);
  const bool by_energy = options.metric == Metric::kEnergy;
  if (!attributes.empty() && !by_energy)
    add_faces_to_attributes(surface, attributes, options.threads);
  CollapserOptions collapser_options;
  collapser_options.legality = options.legality;
  Collapser collapser(surface, &attributes, collapser_options);
  const PoseField poses(surface, mesh.positions, ordering_shapes(mesh, options.poses),
                        options.threads);
  if (!poses.empty()) collapser.poses = &poses;
  PlacementLog placement;
  const CollapseLog log =
      by_energy ? run_energy({surface, mesh, &attributes}, options, placed ? &placement : nullptr)
      : placed  ? run_placed({surface, mesh, &attributes}, options, placement)
                : run_kept(surface, collapser, options);
  if (log.cancelled) return fail(ErrorKind::kCancelled, "cancelled while simplifying");
  result.scratch_bytes = surface.bytes() + attributes.bytes() + poses.bytes() + log.queue_bytes;

  // Number the mesh by the sequence.
  const std::size_t steps = steps_to_target(log, all_faces, options.target_triangles);
  result.stop = report_stop(surface, collapser, options, steps == log.entries.size());
  result.detailed = build_sequence(mesh, surface, log, steps);
  result.detailed.samples = gather_samples(options.poses.samples, result.detailed.original_vertex);
  if (placed) add_placement(result.detailed, surface, placement, steps);
  result.collapse_seconds = seconds_since(start);

  // Measure what the levels are worth.
  if (options.measure_error) {
    const auto measure_start = Clock::now();
    if (!measure_deviation(result.detailed, {options.threads, options.progress}))
      return fail(ErrorKind::kCancelled, "cancelled while measuring the error");
    result.measure_seconds = seconds_since(measure_start);
  }
  CollapseSequence& sequence = result.detailed.sequence;
  if (const std::uint32_t level = sequence.level_for_error(options.max_error); level > 0) {
    cut_below(level, sequence);
    result.stop.reason = StopReason::kErrorReached;
    result.stop.advice.clear();
  }
  result.stop.triangles = sequence.triangles.front();
  return result;
}

}  // namespace varifold
