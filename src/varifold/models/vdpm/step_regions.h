// The bounds of a step as regions that views are asked about.
#pragma once

#include <varifold/models/vdpm/step_bounds.h>
#include <varifold/models/vdpm/view_query.h>
#include <varifold/view/cone_code.h>
#include <varifold/view/criteria.h>
#include <algorithm>

namespace varifold {

/// Of the angles of a step's cones, without their axis: as unpack_cone() and nested_cone() have
/// them.
[[nodiscard]] inline float own_cosine(const StepBounds& bounds) {
  const float part = static_cast<float>(bounds.cone & 1023u) / cone_code::kAngleSteps;
  return 1 - 2 * part * part;
}
[[nodiscard]] inline float nested_cosine(const StepBounds& bounds) {
  if (bounds.nested_angle == StepBounds::kWide) return -1;
  const float part = static_cast<float>(bounds.nested_angle) / step_bounds::kAngleSteps;
  return 1 - part * part;
}

/// mu and delta of a step as a view judges them; as a length, the greater one from all sides.
struct StepDeviation {
  float mu, delta;
};
[[nodiscard]] inline StepDeviation own_deviation(const StepBounds& bounds,
                                                 DeviationMeasure measure) {
  if (measure == DeviationMeasure::kSeen) return {bounds.mu_length(), bounds.delta_length()};
  return {error_of_code(std::max(bounds.mu, bounds.delta)), 0};
}

/// What the step itself changes.
[[nodiscard]] inline ViewRegion own_region(const StepBounds& bounds, const Vec3& center,
                                           DeviationMeasure measure = DeviationMeasure::kSeen) {
  const StepDeviation deviation = own_deviation(bounds, measure);
  return {center, bounds.radius_length(), bounds.own_cone(), deviation.mu, deviation.delta};
}

/// What it and all steps below it in the watch tree change.
[[nodiscard]] inline ViewRegion nested_region(const StepBounds& bounds, const Vec3& center) {
  return {center, bounds.nested_radius_length(), bounds.nested_cone(), bounds.nested_error_length(),
          0};
}

}  // namespace varifold
