// Normal cones in four bytes.
//
// Based on: [Cigolle2014] (octahedral coordinates).
// Differs: the angle takes up what the axis loses, so that a packed cone holds the cone it is of.
#pragma once

#include <varifold/view/cone.h>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace varifold {

/// The cone of every direction.
inline constexpr std::uint32_t kWideConeCode = 1023;

namespace cone_code {

inline constexpr int kAxisSteps = 2047;   // of 11 bits, an odd number so that 0 is one of them
inline constexpr int kAngleSteps = 1023;  // of 10 bits: 1 - cosine = 2 (code / kAngleSteps)^2

[[nodiscard]] inline Vec3 axis_of(std::uint32_t x_code, std::uint32_t y_code) {
  constexpr int kMiddle = (kAxisSteps - 1) / 2;
  const int x = static_cast<int>(x_code) - kMiddle, y = static_cast<int>(y_code) - kMiddle;
  Vec3 n(x, y, kMiddle - std::abs(x) - std::abs(y));
  if (n.z < 0) {  // the lower half, folded outwards
    n.x = static_cast<float>((kMiddle - std::abs(y)) * (x < 0 ? -1 : 1));
    n.y = static_cast<float>((kMiddle - std::abs(x)) * (y < 0 ? -1 : 1));
  }
  return glm::normalize(n);
}

}  // namespace cone_code

/// The cone of a code; of any 32 bits.
[[nodiscard]] inline NormalCone unpack_cone(std::uint32_t code) {
  constexpr auto kLast = static_cast<std::uint32_t>(cone_code::kAxisSteps - 1);
  const std::uint32_t angle = code & 1023u;
  NormalCone cone;
  cone.axis =
      cone_code::axis_of(std::min(code >> 21u, kLast), std::min(code >> 10u & 2047u, kLast));
  const float part = static_cast<float>(angle) / cone_code::kAngleSteps;
  cone.cosine = 1 - 2 * part * part;
  cone.sine = std::sqrt(std::max(0.0f, 1 - cone.cosine * cone.cosine));
  return cone;
}

namespace cone_code {

/// The code of a cone of angle 0 about the axis that codes have nearest to `axis`, not 0. O(1).
[[nodiscard]] inline std::uint32_t code_of_axis(const Vec3& axis) {
  constexpr float kMiddle = 0.5f * (kAxisSteps - 1);
  Vec2 p = Vec2(axis.x, axis.y) / (std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z));
  if (axis.z < 0)
    p = Vec2((1 - std::abs(p.y)) * (p.x < 0 ? -1.0f : 1.0f),
             (1 - std::abs(p.x)) * (p.y < 0 ? -1.0f : 1.0f));
  const auto place = [](float unit) {
    return static_cast<std::uint32_t>(
        std::clamp(std::floor((unit + 1) * kMiddle + 0.5f), 0.0f, 2 * kMiddle));
  };
  return place(p.x) << 21u | place(p.y) << 10u;
}

/// The code of a cone about the axis of `axis_code`, whose angle is at least 2
/// asin(`sine_of_half`).
[[nodiscard]] inline std::uint32_t with_angle(std::uint32_t axis_code, double sine_of_half) {
  // 1 - cos(angle) = 2 sin^2(angle / 2). The last part is for the roundings of unpack_cone().
  const double part = std::ceil(sine_of_half * kAngleSteps + 0.05);
  return (axis_code & ~1023u) | std::min<std::uint32_t>(1023, static_cast<std::uint32_t>(part));
}

}  // namespace cone_code

/// A code whose cone holds `cone`, and whose angle is seldom more than 0.2 degrees greater.
[[nodiscard]] inline std::uint32_t pack_cone(const NormalCone& cone) {
  const Vec3 a = cone.axis;
  const float sum = std::abs(a.x) + std::abs(a.y) + std::abs(a.z);
  if (!(sum > 0) || cone.cosine <= -1) return kWideConeCode;
  const std::uint32_t code = cone_code::code_of_axis(a);
  // In double: cosines say little about small angles.
  const glm::dvec3 kept(unpack_cone(code).axis), axis(a);
  const double turn = std::atan2(glm::length(glm::cross(kept, axis)), glm::dot(kept, axis));
  const double angle = std::acos(std::clamp(static_cast<double>(cone.cosine), -1.0, 1.0)) + turn;
  return cone_code::with_angle(code, std::sin(std::min(angle, 3.141592653589793) / 2));
}

}  // namespace varifold
