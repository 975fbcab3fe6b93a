// What a view wants to know of a step: where it is, how it is turned, how far it moves the surface.
#pragma once

#include <varifold/base/math.h>
#include <varifold/base/progress.h>
#include <varifold/models/common/step_graph.h>
#include <varifold/simplify/collapse_sequence.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Bounds of one step, all rounded outwards; lengths are error codes (error_code.h). The own ones
/// are those of the triangles around the step's point, before and after; the nested ones hold the
/// own ones of the step and of all below it in the watch tree.
struct StepBounds {
  /// The step's first vertex: its position at full detail is the centre of both balls.
  std::uint32_t vertex = 0;
  std::uint32_t cone = 0;           ///< cone_code.h: axis n and the angle of the own cone
  std::uint16_t radius = 0;         ///< own star
  std::uint16_t nested_radius = 0;  ///< all of the watch subtree
  /// Deviation space of the step's collapse along n: what it moves lies within.
  std::uint16_t mu = 0, delta = 0;
  std::uint16_t nested_error = 0;  ///< at least the length of every deviation of the watch subtree
  /// Of a cone about n that holds the normals of the watch subtree.
  std::uint16_t nested_angle = 0;

  /// A nested_angle that holds every direction.
  static constexpr std::uint16_t kWide = 0xffff;
  friend bool operator==(const StepBounds&, const StepBounds&) = default;
};

struct StepBoundsOptions {
  int threads = 0;
  Progress progress;
  /// For height fields: deviations are measured along `up`.
  bool vertical = false;
  Vec3 up{0, 0, 1};
};

/// Sets the bounds of all steps. `watch_parent`: per step, the coarser step above it in the watch
/// tree, or kNone. Returns false when cancelled.
bool measure_step_bounds(const DetailedMesh& detailed, const StepGraph& graph,
                         std::span<const std::uint32_t> watch_parent,
                         const StepBoundsOptions& options, std::vector<StepBounds>& bounds);

}  // namespace varifold
