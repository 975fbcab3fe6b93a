#include <varifold/models/vdpm/step_bounds.h>

#include <varifold/models/vdpm/deviation_space.h>
#include <varifold/models/vdpm/vertical_nearest.h>
#include <varifold/models/vdpm/watch_bounds.h>
#include <varifold/simplify/sample_carrier.h>
#include <varifold/simplify/sequence_replay.h>
#include <optional>

namespace varifold {

namespace {

// Floats are rounded a few times on their way; the bounds must hold all the same.
constexpr double kRounding = 1 + 1e-5;
constexpr float kCosineRounding = 1e-6f;

std::uint16_t length_code(double length) {
  return static_cast<std::uint16_t>(error_code(static_cast<float>(length * kRounding)));
}

// The code of a cone about the sum of some normals, or about an axis that is given.
std::uint32_t cone_of(const std::vector<Vec3>& normals, std::optional<std::uint32_t> axis_code) {
  Vec3 sum(0);
  for (const Vec3& n : normals) sum += n;
  if (!axis_code && !(glm::dot(sum, sum) > 0)) return kWideConeCode;
  const std::uint32_t code = axis_code ? *axis_code : cone_code::code_of_axis(sum);
  const Vec3 axis = unpack_cone(code).axis;
  float cosine = normals.empty() ? -1.0f : 1.0f;
  for (const Vec3& n : normals) cosine = std::min(cosine, glm::dot(axis, n));
  // Beyond 90 degrees the angle does not matter, but the axis does.
  if (cosine <= kCosineRounding) return cone_code::with_angle(code, 1);
  return cone_code::with_angle(code, std::sqrt((1 - double{cosine} + kCosineRounding) / 2));
}

// Walks down the sequence and measures the star of each collapse, before and after it.
class StarWalk {
 public:
  StarWalk(const DetailedMesh& detailed, std::optional<std::uint32_t> axis_code)
      : sequence_(detailed.sequence),
        positions_(detailed.mesh.positions),
        replay_(detailed),
        axis_code_(axis_code) {}

  [[nodiscard]] std::uint32_t level() const { return replay_.level(); }
  void collapse(StepBounds& bounds, Vec3& center) {
    const std::uint32_t k = replay_.level() - 1;
    bounds.vertex = sequence_.vertices[k];
    center = center_ = positions_[bounds.vertex];
    squared_ = 0;
    normals_.clear();
    slots_.clear();
    for (std::uint32_t v = sequence_.vertices[k]; v < sequence_.vertices[k + 1]; ++v)
      replay_.slots_of(v, slots_);
    add_star(k);
    replay_.collapse();
    slots_.assign(replay_.changed().begin(), replay_.changed().end());
    for (std::uint32_t j = first_placed(k); j < first_placed(k + 1); ++j)
      positions_[sequence_.placed_vertex[j]] = sequence_.placed.positions[j];
    add_star(k);
    bounds.radius = length_code(std::sqrt(squared_));
    bounds.cone = cone_of(normals_, axis_code_);
  }

 private:
  [[nodiscard]] std::uint32_t first_placed(std::uint32_t level) const {
    return sequence_.moves_vertices() ? sequence_.first_placed[level] : 0;
  }
  // The triangles of slots_ and those around the vertices that the step moves.
  void add_star(std::uint32_t step) {
    for (std::uint32_t j = first_placed(step); j < first_placed(step + 1); ++j)
      replay_.slots_of(sequence_.placed_vertex[j], slots_);
    if (sequence_.moves_vertices()) keep_triangles_once();
    for (const std::uint32_t slot : slots_) {
      const std::uint32_t* corner = &replay_.corners()[3 * std::size_t{slot / 3}];
      const Vec3 p[3] = {positions_[corner[0]], positions_[corner[1]], positions_[corner[2]]};
      for (const Vec3& q : p) {
        const DVec3 from_center = DVec3(q) - DVec3(center_);
        squared_ = std::max(squared_, glm::dot(from_center, from_center));
      }
      const Vec3 normal = normalize_or_zero(glm::cross(p[1] - p[0], p[2] - p[0]));
      if (normal != Vec3(0)) normals_.push_back(normal);
    }
  }

  void keep_triangles_once() {
    for (std::uint32_t& slot : slots_) slot -= slot % 3;
    std::sort(slots_.begin(), slots_.end());
    slots_.erase(std::unique(slots_.begin(), slots_.end()), slots_.end());
  }

  const CollapseSequence& sequence_;
  std::vector<Vec3> positions_;  // at the present level
  SequenceReplay replay_;
  std::optional<std::uint32_t> axis_code_;
  Vec3 center_{0};
  double squared_ = 0;
  std::vector<std::uint32_t> slots_;
  std::vector<Vec3> normals_;
};

bool measure_stars(const DetailedMesh& detailed, const StepBoundsOptions& options,
                   std::vector<StepBounds>& bounds, std::vector<Vec3>& centers) {
  constexpr std::uint32_t kReportEvery = 16384;
  std::optional<std::uint32_t> axis_code;
  if (options.vertical) axis_code = cone_code::code_of_axis(options.up);
  StarWalk walk(detailed, axis_code);
  for (std::size_t k = bounds.size(); k-- > 0;) {
    walk.collapse(bounds[k], centers[k]);
    if (k % kReportEvery == 0 &&
        !report(options.progress, "stars",
                1 - static_cast<float>(k) / static_cast<float>(bounds.size())))
      return false;
  }
  return true;
}

// One collapse of a carrier, with what it does to its samples.
template <bool kVertical, class Nearest>
void gather_residuals(const DetailedMesh& detailed, const std::vector<StepBounds>& bounds,
                      Nearest& nearest, SampleCarrier& carrier,
                      std::vector<DeviationGatherer>& spaces) {
  const std::uint32_t step = carrier.level() - 1;
  const Vec3 axis = bounds[step].own_cone().axis;
  const std::uint32_t target = detailed.sequence.target[bounds[step].vertex];
  DeviationGatherer space;
  carrier.collapse(nearest, [&](const SampleCarrier::Sample& sample, Vec3 residual) {
    // The triangles at the target of an ear are no part of its star: they may be others where
    // levels differ from place to place. The target is there.
    if (carrier.is_ear()) residual = carrier.position(target) - sample.position;
    const float along = glm::dot(residual, axis);
    const float across = glm::length(residual - along * axis);
    if constexpr (kVertical)
      space.add_vertical(std::abs(along), across);
    else
      space.add(std::abs(along), across);
  });
  spaces[step] = space;
}

bool measure_spaces(const DetailedMesh& detailed, const StepBoundsOptions& options,
                    std::vector<StepBounds>& bounds) {
  const std::uint32_t shares = sample_shares(options.threads, detailed.sequence);
  std::vector<std::vector<DeviationGatherer>> spaces(shares,
                                                     std::vector<DeviationGatherer>(bounds.size()));
  std::vector<NearestTriangle> nearest(shares);
  const Vec3 up = unpack_cone(cone_code::code_of_axis(options.up)).axis;
  std::vector<VerticalNearest> vertical(shares, VerticalNearest(up));
  const auto collapse = [&](std::uint32_t share, SampleCarrier& carrier) {
    if (options.vertical)
      gather_residuals<true>(detailed, bounds, vertical[share], carrier, spaces[share]);
    else
      gather_residuals<false>(detailed, bounds, nearest[share], carrier, spaces[share]);
  };
  if (!carry_samples(
          detailed, {options.threads, options.progress, options.inside_triangles, options.on_edges},
          collapse))
    return false;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    DeviationGatherer all;
    for (const auto& share : spaces) all.add(share[k]);
    const DeviationSpace space = options.vertical ? all.vertical() : all.best();
    bounds[k].mu = length_code(space.mu);
    bounds[k].delta = length_code(space.delta);
  }
  return true;
}

}  // namespace

bool measure_step_bounds(const DetailedMesh& detailed, std::span<const std::uint32_t> watch_parent,
                         const StepBoundsOptions& options, std::vector<StepBounds>& bounds) {
  bounds.assign(detailed.sequence.step_count(), {});
  std::vector<Vec3> centers(bounds.size());
  if (!measure_stars(detailed, options, bounds, centers)) return false;
  if (!measure_spaces(detailed, options, bounds)) return false;
  nest_bounds(watch_parent, centers, bounds);
  return true;
}

}  // namespace varifold
