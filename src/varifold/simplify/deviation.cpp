#include <varifold/simplify/deviation.h>

#include <varifold/simplify/pose_deviation.h>
#include <varifold/simplify/sample_carrier.h>
#include <algorithm>
#include <cmath>
#include <optional>

namespace varifold {

namespace {

// Distances are rounded a few times on their way; the bound must hold all the same.
constexpr float kRounding = 1 + 1e-5f;

// The same for a mesh that takes several shapes.
class InShapes {
 public:
  InShapes(const DetailedMesh& detailed, std::uint32_t shares) : shapes_(detailed) {
    for (std::uint32_t share = 0; share < shares; ++share)
      finders_.push_back({surface_samples(detailed, {0, 0, share, shares}), SampleShapes(shapes_)});
  }

  // The greatest bound of the samples that the next collapse moves.
  [[nodiscard]] float collapse(std::uint32_t share, SampleCarrier& carrier) {
    Finder& finder = finders_[share];
    if (!finder.nearest) finder.nearest.emplace(shapes_, carrier.corners());
    finder.greatest = 0;
    carrier.collapse(finder, [](const SampleCarrier::Sample&, const Vec3&) {});
    return finder.greatest;
  }

 private:
  struct Finder {
    std::vector<SurfaceSample> samples;
    SampleShapes shapes;
    std::optional<NearestInShapes> nearest;
    float greatest = 0;

    void reset(const std::vector<StarTriangle>& triangles) { nearest->reset(triangles); }
    std::size_t find(const SampleCarrier::Sample& sample) {
      const std::span<const Vec3> at = shapes.of(samples[sample.number]);
      const std::size_t found = nearest->find(at);
      greatest = std::max(greatest, nearest->greatest_way(at));
      return found;
    }
  };
  ShapeTable shapes_;
  std::vector<Finder> finders_;
};

float greatest_residual(NearestTriangle& nearest, SampleCarrier& carrier) {
  float greatest = 0;
  carrier.collapse(nearest, [&](const SampleCarrier::Sample&, const Vec3& residual) {
    greatest = std::max(greatest, glm::dot(residual, residual));
  });
  return std::sqrt(greatest);
}

}  // namespace

std::vector<float> step_deviations(const DetailedMesh& detailed, const DeviationOptions& options) {
  const std::uint32_t steps = detailed.sequence.step_count();
  const std::uint32_t shares = sample_shares(options.threads, detailed.sequence);
  std::vector<std::vector<float>> distance(shares, std::vector<float>(steps, 0));
  std::vector<NearestTriangle> nearest(shares);
  std::optional<InShapes> in_shapes;
  if (detailed.has_shapes()) in_shapes.emplace(detailed, shares);
  const auto collapse = [&](std::uint32_t share, SampleCarrier& carrier) {
    const float greatest = in_shapes ? in_shapes->collapse(share, carrier)
                                     : greatest_residual(nearest[share], carrier);
    distance[share][carrier.level()] = greatest;
  };
  std::optional<SequenceHistory> history;
  if (!detailed.sequence.moves_vertices()) history.emplace(detailed);
  if (!carry_samples(detailed,
                     {.threads = options.threads,
                      .progress = options.progress,
                      .history = history ? &*history : nullptr},
                     collapse))
    return {};

  std::vector<float> deviations(steps);
  for (std::uint32_t level = 0; level < steps; ++level) {
    float greatest = 0;
    for (const auto& share : distance) greatest = std::max(greatest, share[level]);
    deviations[level] = greatest * kRounding;
  }
  return deviations;
}

bool measure_deviation(DetailedMesh& detailed, const DeviationOptions& options) {
  CollapseSequence& sequence = detailed.sequence;
  const std::uint32_t steps = sequence.step_count();
  const std::vector<float> deviations = step_deviations(detailed, options);
  if (deviations.size() != steps) return false;

  sequence.error.assign(steps + 1, 0);
  for (std::uint32_t level = steps; level-- > 0;)
    sequence.error[level] = std::max(sequence.error[level + 1], deviations[level]);
  sequence.error_is_measured = true;
  return true;
}

}  // namespace varifold
