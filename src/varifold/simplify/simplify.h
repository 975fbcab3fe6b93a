// From a triangle mesh to its collapse sequence.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/base/result.h>
#include <varifold/simplify/attribute_field.h>
#include <varifold/simplify/collapse_sequence.h>
#include <varifold/simplify/energy_samples.h>
#include <varifold/simplify/legality.h>
#include <varifold/simplify/working_surface.h>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace varifold {

/// Where the vertices of a collapsed edge go.
enum class Placement {
  kKept,     ///< onto one of its ends: every level uses vertices of the input
  kOptimal,  ///< to the place of least error: smaller errors, one new vertex a step
};

/// What orders the collapses.
enum class Metric {
  kQuadric,  ///< distance to the planes of the faces at hand: fast
  kEnergy,   ///< change of Hoppe's energy over samples of the original: measured, slower
};

/// Which shapes beside that at rest matter to costs, legality and measured errors.
struct PoseUse {
  bool of_mesh = true;  ///< TriangleMesh::poses
  /// More of them: what a skin does, for example. They are no part of the result. A place for each
  /// vertex of the mesh; normals are not looked at.
  std::span<const Pose> samples;
};

struct SimplifyOptions {
  Placement placement = Placement::kKept;
  Metric metric = Metric::kQuadric;
  EnergyOptions energy;  ///< for Metric::kEnergy
  PoseUse poses;
  AttributeWeights attributes;
  LegalityOptions legality;
  /// Stop at the finest level that has at most so many triangles. 0: go on while anything is legal.
  std::uint32_t target_triangles = 0;
  /// Stop at the coarsest level whose measured error is at most this, in model units.
  float max_error = std::numeric_limits<float>::infinity();
  /// Measure the error of every level (deviation.h); otherwise levels carry an estimate.
  bool measure_error = true;
  int threads = 0;  ///< 0 = all; the result does not depend on it
  Progress progress;
};

enum class StopReason {
  kTargetReached,  ///< the asked number of triangles
  kErrorReached,   ///< the next collapse would have exceeded the asked error
  kExhausted,      ///< no legal collapse is left, and none was expected to be: the base is small
  kStuck,          ///< no legal collapse is left far above the target
};

/// Names as in reports and JSON: target_reached, error_reached, exhausted, stuck.
[[nodiscard]] const char* stop_reason_name(StopReason reason);

/// Why and where a simplification stopped.
struct StopReport {
  StopReason reason = StopReason::kExhausted;
  std::uint32_t triangles = 0;  ///< at the last level
  /// Points that were left when no legal collapse was, by kind.
  std::array<std::uint32_t, kVertexKindCount> left_by_kind{};
  /// For each point left, why its cheapest collapse was refused.
  std::array<std::uint32_t, kRefusalCount> refusals{};
  /// One or two sentences that say what would help; empty where nothing needs to.
  std::string advice;
};

struct Simplification {
  DetailedMesh detailed;
  StopReport stop;
  InputFaults faults;
  std::uint64_t scratch_bytes = 0;  ///< memory at work beside input and output, its peak
  double collapse_seconds = 0;      ///< the sequence alone
  double measure_seconds = 0;
};

/// Orders edge collapses by quadric error or by energy, attributes included, until the target or
/// until nothing legal is left, and numbers the mesh by that order.
///
/// The mesh may be open, non-manifold, of several components, with seams: topology is that of
/// position classes; borders, seams, material borders and non-manifold edges collapse along
/// themselves (vertex_kind.h). Vertices that no triangle uses, and triangles without three distinct
/// positions, are left out. Vertices with equal attributes are one.
///
/// Poses: one order for all of them; costs are means over the poses, and what is legal is so in
/// each. Vertices are one point only where no pose parts them (weld_points()).
///
/// Guarantees: every level has the Euler characteristic, borders and orientation of the input; no
/// triangle turned by a step by more than 75 degrees; same bytes for any number of threads.
/// Errors: kInvalidInput when indices or array sizes are wrong or positions are not finite;
/// kUnsupported for poses with another placement or metric than the first ones; kCancelled. O(n log
/// n) time, under 200 bytes of scratch a vertex without attributes.
[[nodiscard]] Result<Simplification> simplify(const TriangleMesh& mesh,
                                              const SimplifyOptions& options = {});

}  // namespace varifold
