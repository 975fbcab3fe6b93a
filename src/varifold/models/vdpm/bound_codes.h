// What is measured of a step, rounded outwards into the codes of StepBounds.
#pragma once

#include <varifold/models/common/error_code.h>
#include <varifold/view/cone_code.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace varifold::bound_codes {

// Floats are rounded a few times on their way; the bounds must hold all the same.
inline constexpr double kRounding = 1 + 1e-5;
inline constexpr float kCosineRounding = 1e-6f;

[[nodiscard]] inline std::uint16_t length_code(double length) {
  return static_cast<std::uint16_t>(error_code(static_cast<float>(length * kRounding)));
}

/// The code of a cone about the sum of some normals, or about an axis that is given.
[[nodiscard]] inline std::uint32_t cone_of(const std::vector<Vec3>& normals,
                                           std::optional<std::uint32_t> axis_code) {
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

}  // namespace varifold::bound_codes
