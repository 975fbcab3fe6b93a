// Deviation spaces: how far a surface is off, along its normal and across it.
//
// Based on: [Hoppe1997] section 4, screen-space geometric error.
// Differs: the ratio of the two numbers is chosen from a list, as the one that looks smallest from
//   all sides on average; the paper takes it from the greatest extents along and across the normal.
//   See docs/algorithms/deviation_space.md.
#pragma once

#include <varifold/base/math.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace varifold {

/// All vectors that, seen at any angle t to an axis, are at most max(mu, delta sin t) long: the
/// ball of radius mu and, where delta is greater, the two cones from the points at +-delta on the
/// axis that touch it.
struct DeviationSpace {
  float mu = 0, delta = 0;

  /// What it looks like from all sides, on average.
  [[nodiscard]] float mean_extent() const;
};

namespace deviation_space {

/// The mean of max(1, ratio sin t) over all directions; ratio >= 1. In closed form.
[[nodiscard]] inline double mean_extent(double ratio) {
  constexpr double kHalfPi = 1.57079632679489661923;
  // From the angle at which the ratio takes over, the integral of ratio sin^2 t.
  const double sine = 1 / ratio, cosine = std::sqrt(1 - sine * sine);
  const double angle = std::atan2(sine, cosine);
  return (1 - cosine) + ratio * ((kHalfPi - angle) / 2 + sine * cosine / 2);
}

/// delta / mu of the spaces that are tried, and of each the slope along / across at which the cone
/// touches the ball, turned over: sqrt(ratio^2 - 1); 1 / ratio; mean_extent(ratio).
inline constexpr std::array<float, 8> kRatios = {1, 1.25f, 1.75f, 2.5f, 4, 7, 15, 50};
inline constexpr std::array<float, 8> kSlopes = {0,           0.75f,       1.43614066f, 2.29128785f,
                                                 3.87298335f, 6.92820323f, 14.9666295f, 49.989999f};
inline constexpr std::array<float, 8> kInverses = {1,     0.8f,         0.571428571f,  0.4f,
                                                   0.25f, 0.142857143f, 0.0666666667f, 0.02f};
inline constexpr std::array<float, 8> kMeanExtents = {
    1, 1.10218819f, 1.431906f, 1.99084178f, 3.15210923f, 5.50119899f, 11.7817137f, 39.2699748f};

}  // namespace deviation_space

/// Gathers residuals and finds a small space for them. A space that holds all of them in every
/// ratio at once, so that parts can be gathered in any order and by several threads.
class DeviationGatherer {
 public:
  /// A residual of so much along the axis and across it; both at least 0. O(ratios).
  void add(float along, float across) {
    const float length = std::sqrt(along * along + across * across);
    for (std::size_t i = 0; i < kCount; ++i) {
      // Beside the ball lies the cone; it touches the ball at this slope.
      const float in_cone =
          (along + across * deviation_space::kSlopes[i]) * deviation_space::kInverses[i];
      const float size = along * deviation_space::kSlopes[i] > across ? in_cone : length;
      mu_[i] = std::max(mu_[i], size);
    }
  }
  void add(const DeviationGatherer& other) {
    for (std::size_t i = 0; i < kCount; ++i) mu_[i] = std::max(mu_[i], other.mu_[i]);
  }
  /// The space of the least mean extent among those tried.
  [[nodiscard]] DeviationSpace best() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < kCount; ++i)
      if (mu_[i] * deviation_space::kMeanExtents[i] <
          mu_[best] * deviation_space::kMeanExtents[best])
        best = i;
    return {mu_[best], mu_[best] * deviation_space::kRatios[best]};
  }

  /// The same for residuals that lie along the axis, but for a few: not to be mixed with the above.
  void add_vertical(float along, float across) {
    if (across <= 1e-6f * along)
      mu_[1] = std::max(mu_[1], along);
    else
      mu_[0] = std::max(mu_[0], std::sqrt(along * along + across * across));
  }
  [[nodiscard]] DeviationSpace vertical() const { return {mu_[0], mu_[1]}; }

 private:
  static constexpr std::size_t kCount = deviation_space::kRatios.size();
  std::array<float, kCount> mu_{};
};

inline float DeviationSpace::mean_extent() const {
  if (delta <= mu) return mu;
  if (mu <= 0) return static_cast<float>(delta * deviation_space::mean_extent(1e12) / 1e12);
  return static_cast<float>(mu * deviation_space::mean_extent(double{delta} / double{mu}));
}

}  // namespace varifold
