#include <varifold/models/vdpm/step_bounds.h>

#include <varifold/models/vdpm/bound_codes.h>
#include <varifold/models/vdpm/deviation_space.h>
#include <varifold/models/vdpm/shape_bounds.h>
#include <varifold/models/vdpm/vertical_nearest.h>
#include <varifold/models/vdpm/watch_bounds.h>
#include <varifold/simplify/sample_carrier.h>
#include <optional>
#include <utility>

namespace varifold {

namespace {

using bound_codes::cone_of;
using bound_codes::length_code;

// Measures the star of a collapse, before and after it.
class StarMeasure {
 public:
  StarMeasure(bool keeps_vertices, std::optional<std::uint32_t> axis_code)
      : keeps_vertices_(keeps_vertices), axis_code_(axis_code) {}

  void begin(const Vec3& center) {
    center_ = center;
    squared_ = 0;
    normals_.clear();
  }
  void add(const SampleCarrier& carrier, std::span<const std::uint32_t> slots) {
    if (!keeps_vertices_) slots = triangles_once(slots);
    for (const std::uint32_t slot : slots) {
      const std::uint32_t* corner = &carrier.corners()[3 * std::size_t{slot / 3}];
      const Vec3 p[3] = {carrier.position(corner[0]), carrier.position(corner[1]),
                         carrier.position(corner[2])};
      for (const Vec3& q : p) {
        const DVec3 from_center = DVec3(q) - DVec3(center_);
        squared_ = std::max(squared_, glm::dot(from_center, from_center));
      }
      const Vec3 normal = normalize_or_zero(glm::cross(p[1] - p[0], p[2] - p[0]));
      if (normal != Vec3(0)) normals_.push_back(normal);
    }
  }
  [[nodiscard]] std::uint16_t radius() const { return length_code(std::sqrt(squared_)); }
  [[nodiscard]] std::uint32_t cone() const { return cone_of(normals_, axis_code_); }

 private:
  std::span<const std::uint32_t> triangles_once(std::span<const std::uint32_t> slots) {
    slots_.assign(slots.begin(), slots.end());
    for (std::uint32_t& slot : slots_) slot -= slot % 3;
    std::sort(slots_.begin(), slots_.end());
    slots_.erase(std::unique(slots_.begin(), slots_.end()), slots_.end());
    return slots_;
  }

  bool keeps_vertices_;
  std::optional<std::uint32_t> axis_code_;
  Vec3 center_{0};
  double squared_ = 0;
  std::vector<std::uint32_t> slots_;
  std::vector<Vec3> normals_;
};

// What a carrier finds out about all steps with its share of the samples.
struct ShareOfBounds {
  StarMeasure star;
  NearestTriangle nearest;
  VerticalNearest vertical;
  std::vector<DeviationGatherer> spaces;
  // Where the stars are noted, in one of the shares.
  std::vector<StepBounds>* bounds = nullptr;
  std::vector<Vec3>* centers = nullptr;
};

// One collapse of a carrier: its star, and what it does to samples. Every carrier measures the
// stars, since it needs their axes at once; one of them notes them.
template <bool kVertical, class Nearest>
void measure_step(const CollapseSequence& sequence, Nearest& nearest, ShareOfBounds& share,
                  SampleCarrier& carrier) {
  const std::uint32_t step = carrier.level() - 1;
  const std::uint32_t vertex = sequence.vertices[step], target = sequence.target[vertex];
  const Vec3 center = carrier.position(vertex);
  share.star.begin(center);
  bool is_after = false;
  Vec3 axis(0);
  const auto add_star = [&](std::span<const std::uint32_t> slots) {
    share.star.add(carrier, slots);
    if (!std::exchange(is_after, true)) return;
    const std::uint32_t cone = share.star.cone();
    axis = unpack_cone(cone).axis;
    if (share.bounds == nullptr) return;
    StepBounds& bounds = (*share.bounds)[step];
    bounds.vertex = vertex;
    bounds.cone = cone;
    bounds.radius = share.star.radius();
    (*share.centers)[step] = center;
  };
  DeviationGatherer space;
  const auto add_residual = [&](const SampleCarrier::Sample& sample, Vec3 residual) {
    // The triangles at the target of an ear are no part of its star: they may be others where
    // levels differ from place to place. The target is there.
    if (carrier.is_ear()) residual = carrier.position(target) - sample.position;
    const float along = glm::dot(residual, axis);
    const float across = glm::length(residual - along * axis);
    if constexpr (kVertical)
      space.add_vertical(std::abs(along), across);
    else
      space.add(std::abs(along), across);
  };
  carrier.collapse(nearest, add_residual, add_star);
  share.spaces[step] = space;
}

bool measure_own_bounds(const DetailedMesh& detailed, const StepBoundsOptions& options,
                        const SequenceHistory* history, std::vector<Vec3>& centers,
                        std::vector<StepBounds>& bounds) {
  const CollapseSequence& sequence = detailed.sequence;
  const std::uint32_t up = cone_code::code_of_axis(options.up);
  const StarMeasure star(!sequence.moves_vertices(),
                         options.vertical ? std::optional(up) : std::nullopt);
  std::vector<ShareOfBounds> shares(sample_shares(options.threads, sequence),
                                    {star,
                                     {},
                                     VerticalNearest(unpack_cone(up).axis),
                                     std::vector<DeviationGatherer>(bounds.size())});
  shares[0].bounds = &bounds;
  shares[0].centers = &centers;
  const auto collapse = [&](std::uint32_t number, SampleCarrier& carrier) {
    ShareOfBounds& share = shares[number];
    if (options.vertical)
      measure_step<true>(sequence, share.vertical, share, carrier);
    else
      measure_step<false>(sequence, share.nearest, share, carrier);
  };
  if (!carry_samples(
          detailed,
          {options.threads, options.progress, options.inside_triangles, options.on_edges, history},
          collapse))
    return false;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    DeviationGatherer all;
    for (const ShareOfBounds& share : shares) all.add(share.spaces[k]);
    const DeviationSpace space = options.vertical ? all.vertical() : all.best();
    bounds[k].mu = length_code(space.mu);
    bounds[k].delta = length_code(space.delta);
  }
  return true;
}

}  // namespace

bool measure_step_bounds(const DetailedMesh& detailed, std::span<const std::uint32_t> watch_parent,
                         const StepBoundsOptions& options, std::vector<StepBounds>& bounds,
                         const SequenceHistory* history) {
  bounds.assign(detailed.sequence.step_count(), {});
  std::vector<Vec3> centers(bounds.size());
  {
    std::optional<SequenceHistory> own;
    if (history == nullptr && !detailed.sequence.moves_vertices()) history = &own.emplace(detailed);
    if (detailed.has_shapes()) {
      centers = shape_centers(detailed);
      if (!measure_bounds_in_shapes(detailed, options, history, centers, bounds)) return false;
    } else if (!measure_own_bounds(detailed, options, history, centers, bounds)) {
      return false;
    }
  }
  nest_bounds(watch_parent, centers, bounds);
  return true;
}

}  // namespace varifold
