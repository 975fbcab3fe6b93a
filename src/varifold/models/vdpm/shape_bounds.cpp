#include <varifold/models/vdpm/shape_bounds.h>

#include <varifold/models/vdpm/bound_codes.h>
#include <varifold/models/vdpm/deviation_space.h>
#include <varifold/simplify/pose_deviation.h>
#include <varifold/simplify/sample_carrier.h>
#include <cassert>
#include <optional>

namespace varifold {

namespace {

// The star of a collapse, before and after it, in all blends.
class ShapeStar {
 public:
  explicit ShapeStar(const ShapeTable& shapes) : shapes_(shapes) {}

  void begin(const Vec3& center) {
    center_ = center;
    squared_ = 0;
    normals_.clear();
  }
  void add(const std::vector<std::uint32_t>& corners, std::span<const std::uint32_t> slots) {
    for (const std::uint32_t slot : slots) {
      const std::uint32_t* corner = &corners[3 * std::size_t{slot / 3}];
      const std::span<const Vec3> p[3] = {shapes_.of(corner[0]), shapes_.of(corner[1]),
                                          shapes_.of(corner[2])};
      for (const auto& places : p)
        for (const Vec3& place : places) {
          const DVec3 from_center = DVec3(place) - DVec3(center_);
          squared_ = std::max(squared_, glm::dot(from_center, from_center));
        }
      add_normals(p);
    }
  }
  [[nodiscard]] std::uint16_t radius() const {
    return bound_codes::length_code(std::sqrt(squared_));
  }
  [[nodiscard]] std::uint32_t cone() const { return bound_codes::cone_of(normals_, std::nullopt); }

 private:
  void add_normals(const std::span<const Vec3>* p) {
    for (std::size_t i = 0; i < shapes_.shape_count(); ++i) {
      const Vec3 e = p[1][i] - p[0][i], f = p[2][i] - p[0][i];
      for (std::size_t j = 0; j <= i; ++j) {
        const Vec3 ej = p[1][j] - p[0][j], fj = p[2][j] - p[0][j];
        const Vec3 normal = normalize_or_zero(glm::cross(e, fj) + glm::cross(ej, f));
        if (normal != Vec3(0)) normals_.push_back(normal);
      }
    }
  }

  const ShapeTable& shapes_;
  Vec3 center_{0};
  double squared_ = 0;
  std::vector<Vec3> normals_;
};

// What a carrier finds out about all steps with its share of the samples.
struct Share {
  ShapeStar star;
  SampleShapes shapes;
  std::vector<SurfaceSample> samples;
  std::vector<DeviationGatherer> spaces;
  std::optional<NearestInShapes> nearest;
  std::vector<StepBounds>* bounds = nullptr;  // where stars are noted, in one of the shares
};

// Finds the triangle of a sample and gathers how far it is off.
class Finder {
 public:
  /// Samples of an ear go to `target`.
  Finder(Share& share, const SampleCarrier& carrier, std::span<const Vec3> target)
      : share_(share), carrier_(carrier), target_(target) {}

  void set_axis(const Vec3& axis) { axis_ = axis; }
  void reset(const std::vector<StarTriangle>& triangles) { share_.nearest->reset(triangles); }
  std::size_t find(const SampleCarrier::Sample& sample) {
    const std::span<const Vec3> at = share_.shapes.of(share_.samples[sample.number]);
    const std::size_t found = share_.nearest->find(at);
    if (carrier_.is_ear())
      for (std::size_t i = 0; i < at.size(); ++i) add(target_[i] - at[i]);
    else
      share_.nearest->for_each_way(at, [&](const Vec3& way) { add(way); });
    return found;
  }
  [[nodiscard]] const DeviationGatherer& space() const { return space_; }

 private:
  void add(const Vec3& way) {
    const float along = glm::dot(way, axis_);
    space_.add(std::abs(along), glm::length(way - along * axis_));
  }

  Share& share_;
  const SampleCarrier& carrier_;
  std::span<const Vec3> target_;
  Vec3 axis_{0};
  DeviationGatherer space_;
};

void measure_step(const CollapseSequence& sequence, const ShapeTable& shapes,
                  std::span<const Vec3> centers, Share& share, SampleCarrier& carrier) {
  const std::uint32_t step = carrier.level() - 1;
  const std::uint32_t vertex = sequence.vertices[step];
  share.star.begin(centers[step]);
  Finder finder(share, carrier, shapes.of(sequence.target[vertex]));
  bool is_after = false;
  const auto add_star = [&](std::span<const std::uint32_t> slots) {
    share.star.add(carrier.corners(), slots);
    if (!std::exchange(is_after, true)) return;
    const std::uint32_t cone = share.star.cone();
    finder.set_axis(unpack_cone(cone).axis);
    if (share.bounds == nullptr) return;
    StepBounds& bounds = (*share.bounds)[step];
    bounds.vertex = vertex;
    bounds.cone = cone;
    bounds.radius = share.star.radius();
  };
  carrier.collapse(
      finder, [](const SampleCarrier::Sample&, const Vec3&) {}, add_star);
  share.spaces[step] = finder.space();
}

}  // namespace

std::vector<Vec3> shape_centers(const DetailedMesh& detailed) {
  const auto shapes = detailed.shapes();
  std::vector<Vec3> centers;
  for (std::uint32_t step = 0; step < detailed.sequence.step_count(); ++step) {
    Box box;
    for (const auto& shape : shapes) box.add(shape[detailed.sequence.vertices[step]]);
    centers.push_back(box.center());
  }
  return centers;
}

bool measure_bounds_in_shapes(const DetailedMesh& detailed, const StepBoundsOptions& options,
                              const SequenceHistory* history, std::span<const Vec3> centers,
                              std::vector<StepBounds>& bounds) {
  assert(!options.vertical && options.inside_triangles == 0);
  const ShapeTable shapes(detailed);
  const std::uint32_t count = sample_shares(options.threads, detailed.sequence);
  std::vector<Share> shares;
  for (std::uint32_t i = 0; i < count; ++i)
    shares.push_back({ShapeStar(shapes), SampleShapes(shapes),
                      surface_samples(detailed, {0, options.on_edges, i, count}),
                      std::vector<DeviationGatherer>(bounds.size()), std::nullopt,
                      i == 0 ? &bounds : nullptr});
  const auto collapse = [&](std::uint32_t number, SampleCarrier& carrier) {
    Share& share = shares[number];
    if (!share.nearest) share.nearest.emplace(shapes, carrier.corners());
    measure_step(detailed.sequence, shapes, centers, share, carrier);
  };
  if (!carry_samples(detailed, {options.threads, options.progress, 0, options.on_edges, history},
                     collapse))
    return false;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    DeviationGatherer all;
    for (const Share& share : shares) all.add(share.spaces[k]);
    bounds[k].mu = bound_codes::length_code(all.best().mu);
    bounds[k].delta = bound_codes::length_code(all.best().delta);
  }
  return true;
}

}  // namespace varifold
