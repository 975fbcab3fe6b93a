// The tolerance that a budget of triangles allows.
//
// Based on: [Hoppe1997] section 5.1 (regulation of the tolerance).
// Differs: the paper moves the tolerance a little each frame and overshoots; here each frame finds
//   one that fits, beginning with the last: fronts of nearby tolerances are near each other, so
//   that a trial costs what changes.
#pragma once

#include <varifold/models/common/front_model.h>
#include <varifold/view/criteria.h>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace varifold {

/// Tolerances are steps of a ladder, each 0.27 % above the one before; the lowest is the tolerance
/// that the user asks for. Where views have nothing left to give, the ladder goes on at
/// RefineCriteria::kFullDetail: from there on places of full detail give way, too
/// (front_question.h). Remembers the step of the last frame.
class ToleranceSearch {
 public:
  static constexpr std::int32_t kStepsPerOctave = 256;
  static constexpr std::int32_t kLastOfViews = 40 * kStepsPerOctave;
  static constexpr std::int32_t kLastStep = kLastOfViews + 28 * kStepsPerOctave;

  /// `run(tolerance)` adapts, within the budget, and returns statistics; it fits when no step
  /// is refused and the triangles are not too many; when something else waits the search does, too.
  /// Ends with the front of a tolerance that fits; of the least one with `band` 0, otherwise of one
  /// that leaves at most this part of the budget unused, or the lowest. Where none fits, with that
  /// of the greatest tolerance.
  template <class Run>
  FrontStatistics fit(const AdaptOptions& options, float band, const Run& run);

  /// Tolerance of a step: the same bits everywhere, by multiplications alone.
  [[nodiscard]] static float tolerance_of(float lowest, std::int32_t step);

 private:
  [[nodiscard]] std::int32_t finer_by(double unused) const {
    return std::max(1, static_cast<std::int32_t>(unused / triangles_per_step_));
  }
  void learn(std::int32_t from, std::int32_t to, std::uint32_t before, std::uint32_t after);

  // The first frame comes from the coarse side, where trials are cheap.
  std::int32_t step_ = 12 * kStepsPerOctave;
  double triangles_per_step_ = 0.0025;  // by which part the triangles change with a step
};

inline float ToleranceSearch::tolerance_of(float lowest, std::int32_t step) {
  const bool of_views = step <= kLastOfViews;
  double factor = of_views ? lowest : RefineCriteria::kFullDetail;
  double power = 1.0027112750502025;  // 2^(1/256)
  for (auto bits = static_cast<std::uint32_t>(of_views ? step : step - kLastOfViews); bits != 0;
       bits >>= 1, power *= power)
    if ((bits & 1u) != 0) factor *= power;
  return static_cast<float>(factor);
}

inline void ToleranceSearch::learn(std::int32_t from, std::int32_t to, std::uint32_t before,
                                   std::uint32_t after) {
  if (from == to || before == 0 || after == 0) return;
  const double change = std::abs(std::log(static_cast<double>(after) / before) / (to - from));
  triangles_per_step_ = std::clamp(0.5 * (triangles_per_step_ + change), 0.0005, 0.01);
}

template <class Run>
FrontStatistics ToleranceSearch::fit(const AdaptOptions& options, float band, const Run& run) {
  const auto wanted = static_cast<double>(options.max_triangles);
  const auto attempt = [&](std::int32_t step) {
    return run(tolerance_of(std::max(options.tolerance, 1e-9f), step));
  };
  // Steps up to too_fine do not fit, those from `fits` on do.
  const double aim = 0.5 * static_cast<double>(band);  // the middle of what may stay unused
  std::int32_t too_fine = -1, fits = kLastStep + 1, step = step_, jump = 1;
  FrontStatistics last, best;
  std::int32_t last_step = step;
  for (;; jump = std::min(2 * jump, kStepsPerOctave)) {
    last = attempt(step);
    last_step = step;
    if (last.waiting > last.refused) return last;  // no more is to be done now
    if (last.refused > 0 || last.triangles > options.max_triangles) {
      too_fine = step;
      step = fits <= kLastStep ? (step + fits) / 2 : std::min(kLastStep, step + jump);
    } else {
      if (fits <= kLastStep) learn(fits, step, best.triangles, last.triangles);
      fits = step;
      best = last;
      const double unused = std::log(wanted / std::max(1.0, static_cast<double>(last.triangles)));
      if (step == 0 || unused < static_cast<double>(band)) break;
      step = std::max(step - std::max(finer_by(unused - aim), jump), (too_fine + step) / 2);
    }
    if (fits - too_fine == 1 || too_fine == kLastStep) break;
    step = std::clamp(step, too_fine + 1, std::min(fits - 1, kLastStep));
  }
  if (fits <= kLastStep && last_step != fits) last = attempt(fits);
  step_ = std::min(fits, kLastStep);
  return last;
}

}  // namespace varifold
