// What a view asks of every step: where it is, how it is turned and how far it is off; and the same
// of all steps that are watched below it.
//
// Based on: [Hoppe1997] section 4 (bounding spheres, normal cones, deviation spaces).
// Differs: a step has bounds of its own star beside the nested ones; the nested ones follow the
//   watch tree, not the tree of vertices; points on the edges are samples, too.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/models/common/error_code.h>
#include <varifold/simplify/collapse_sequence.h>
#include <varifold/simplify/sequence_history.h>
#include <varifold/view/cone_code.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// The bounds of a step, rounded outwards. Its star are the triangles around the point that the
/// collapse removes (and, with optimal placement, around those that it moves), at the level before
/// it, and those of them that are left after it.
struct StepBounds {
  static constexpr std::uint16_t kWide = 0xffff;

  std::uint32_t vertex = 0;            ///< the first one of the step; both balls are about it
  std::uint32_t cone = kWideConeCode;  ///< cone_code.h: of the normals of the star
  std::uint16_t radius = 0;            ///< error_code.h: of a ball that holds the star
  std::uint16_t nested_radius = 0;     ///< of one that holds the balls of the watch subtree
  /// Codes of the deviation space about the cone's axis (deviation_space.h): all samples that the
  /// collapse moves are off by vectors in there.
  std::uint16_t mu = 0, delta = 0;
  std::uint16_t nested_error = 0;      ///< greatest mu or delta of the watch subtree
  std::uint16_t nested_angle = kWide;  ///< about the cone's axis, of the cones of the watch subtree

  [[nodiscard]] float radius_length() const { return error_of_code(radius); }
  [[nodiscard]] float nested_radius_length() const { return error_of_code(nested_radius); }
  [[nodiscard]] float mu_length() const { return error_of_code(mu); }
  [[nodiscard]] float delta_length() const { return error_of_code(delta); }
  [[nodiscard]] float nested_error_length() const { return error_of_code(nested_error); }
  [[nodiscard]] NormalCone own_cone() const { return unpack_cone(cone); }
  /// Holds the own cones of the step and of all below it in the watch tree; about the same axis.
  [[nodiscard]] NormalCone nested_cone() const;
};
static_assert(sizeof(StepBounds) == 20);

/// StepBounds without the vertex, which the level table of a model has: as they lie in memory.
struct PackedBounds {
  std::uint32_t cone = 0;
  std::uint16_t radius = 0, nested_radius = 0, mu = 0, delta = 0, nested_error = 0,
                nested_angle = 0;
};
static_assert(sizeof(PackedBounds) == 16);

struct StepBoundsOptions {
  int threads = 0;  ///< 0 = all; the result does not depend on it
  Progress progress;
  /// Deviations of a height field, along `up` alone, to the triangle above or below the sample:
  /// mu is 0 (but where a border gives way), and cones have `up` as their axis, as near as a cone
  /// code has it.
  bool vertical = false;
  Vec3 up{0, 1, 0};  ///< not 0; any length
  /// Samples of the full mesh, beside all vertices: seeded points in every triangle, and points
  /// on every edge (SampleOptions).
  std::uint32_t inside_triangles = 0;
  std::uint32_t on_edges = 3;
};

/// The bounds of every step. `watch_parent` has a step per step, a smaller one, or kNone.
///
/// Guarantees, for every step:
/// - every sample that its collapse moves (points of edges only while triangles are small, see
///   SampleOptions) is off by a vector of the step's deviation space, from the nearest point of the
///   triangles that the collapse leaves of its star; where it leaves none, from its target;
/// - nested balls, errors and cones hold the own ones of all steps of the watch subtree.
/// The centre of both balls is the position of `vertex` where the split makes it (with kept
/// vertices, its only one). Where the mesh takes several shapes (DetailedMesh::shapes()), all of
/// this holds in every blend of them, and the centres are shape_centers() (shape_bounds.h).
///
/// O(n log n) expected; 32 bytes of scratch a step and thread share beside those of
/// SampleCarrier. A history of the sequence saves making one. Returns false when cancelled.
bool measure_step_bounds(const DetailedMesh& detailed, std::span<const std::uint32_t> watch_parent,
                         const StepBoundsOptions& options, std::vector<StepBounds>& bounds,
                         const SequenceHistory* history = nullptr);

namespace step_bounds {

inline constexpr int kAngleSteps = 65534;  // 1 - cosine = (code / kAngleSteps)^2

/// The code of an angle of at least that cosine; kWide from 90 degrees on.
[[nodiscard]] inline std::uint16_t angle_code(double cosine) {
  // One more for the roundings of nested_cone().
  const double code = std::ceil(std::sqrt(std::max(0.0, 1 - cosine)) * kAngleSteps) + 1;
  return code < kAngleSteps ? static_cast<std::uint16_t>(code) : StepBounds::kWide;
}

}  // namespace step_bounds

inline NormalCone StepBounds::nested_cone() const {
  NormalCone nested;
  nested.axis = own_cone().axis;
  if (nested_angle == kWide) return nested;
  const float part = static_cast<float>(nested_angle) / step_bounds::kAngleSteps;
  nested.cosine = 1 - part * part;
  nested.sine = std::sqrt(std::max(0.0f, 1 - nested.cosine * nested.cosine));
  return nested;
}

}  // namespace varifold
