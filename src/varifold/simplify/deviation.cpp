#include <varifold/simplify/deviation.h>

#include <varifold/simplify/sample_carrier.h>
#include <algorithm>
#include <cmath>
#include <optional>

namespace varifold {

namespace {

// Distances are rounded a few times on their way; the bound must hold all the same.
constexpr float kRounding = 1 + 1e-5f;

}  // namespace

std::vector<float> step_deviations(const DetailedMesh& detailed, const DeviationOptions& options) {
  const std::uint32_t steps = detailed.sequence.step_count();
  const std::uint32_t shares = sample_shares(options.threads, detailed.sequence);
  std::vector<std::vector<float>> squared(shares, std::vector<float>(steps, 0));
  std::vector<NearestTriangle> nearest(shares);
  const auto collapse = [&](std::uint32_t share, SampleCarrier& carrier) {
    float greatest = 0;
    carrier.collapse(nearest[share], [&](const SampleCarrier::Sample&, const Vec3& residual) {
      greatest = std::max(greatest, glm::dot(residual, residual));
    });
    squared[share][carrier.level()] = greatest;
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
    for (const auto& share : squared) greatest = std::max(greatest, share[level]);
    deviations[level] = std::sqrt(greatest) * kRounding;
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
