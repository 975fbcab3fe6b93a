// The bounds of a step as regions that views are asked about.
#pragma once

#include <varifold/models/vdpm/step_bounds.h>
#include <varifold/models/vdpm/view_query.h>
#include <varifold/view/cone_code.h>

namespace varifold {

/// Of the angles of a step's cones, without their axis: as unpack_cone() and nested_cone() have
/// them.
[[nodiscard]] inline float own_cosine(std::uint32_t cone) {
  const float part = static_cast<float>(cone & 1023u) / cone_code::kAngleSteps;
  return 1 - 2 * part * part;
}
[[nodiscard]] inline float nested_cosine(std::uint32_t nested_angle) {
  static_assert(StepBounds::kWide > step_bounds::kAngleSteps);  // below 0: tells nothing
  const float part = static_cast<float>(nested_angle) / step_bounds::kAngleSteps;
  return 1 - part * part;
}

/// What the step itself changes.
[[nodiscard]] inline ViewRegion own_region(const StepBounds& bounds, const Vec3& center) {
  return {center, bounds.radius_length(), bounds.own_cone(), bounds.mu_length(),
          bounds.delta_length()};
}

/// What it and all steps below it in the watch tree change.
[[nodiscard]] inline ViewRegion nested_region(const StepBounds& bounds, const Vec3& center) {
  return {center, bounds.nested_radius_length(), bounds.nested_cone(), bounds.nested_error_length(),
          0};
}

}  // namespace varifold
