// Angles without the system's libm, whose last bits differ from one system to the next.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <initializer_list>

namespace varifold {

/// The point (cosine, sine) at `numerator` / `denominator` of a full turn. The same bits on every
/// system, within 2^-52 of the exact value, and exactly symmetric: a quarter turn is (0, 1).
/// denominator > 0, below 2^60; any numerator.
[[nodiscard]] inline glm::dvec2 unit_circle(std::uint64_t numerator, std::uint64_t denominator) {
  const std::uint64_t eighths = 8 * (numerator % denominator);
  const auto octant = static_cast<int>(eighths / denominator);
  std::uint64_t rest = eighths % denominator;
  if (octant % 2 == 1) rest = denominator - rest;  // mirrored at the middle of the quadrant

  constexpr double kEighthTurn = 0.78539816339744830962;
  const double x = kEighthTurn * (static_cast<double>(rest) / static_cast<double>(denominator));
  const double x2 = x * x;
  double cosine = 1;
  double sine = 1;
  for (int k = 18; k >= 2; k -= 2) {  // Taylor series; the first term left out is below 2^-60
    cosine = 1 - cosine * x2 / (k * (k - 1));
    sine = 1 - sine * x2 / (k * (k + 1));
  }
  sine *= x;

  switch (octant) {
    case 0:
      return {cosine, sine};
    case 1:
      return {sine, cosine};
    case 2:
      return {-sine, cosine};
    case 3:
      return {-cosine, sine};
    case 4:
      return {-cosine, -sine};
    case 5:
      return {-sine, -cosine};
    case 6:
      return {sine, -cosine};
    default:
      return {cosine, -sine};
  }
}

/// The tangent of half of an angle in [0, 180) degrees, within 4 units in the last place; the same
/// bits on every system. Half the height of a picture at distance one, for an angle of view.
[[nodiscard]] inline double half_angle_tangent(double degrees) {
  // Above a quarter turn of the whole angle, the cotangent of the rest.
  const bool is_wide = degrees > 90;
  constexpr double kHalfRadians = 0.00872664625997164788;
  const double x = kHalfRadians * (is_wide ? 180 - degrees : degrees);
  const double x2 = x * x;
  double cosine = 1;
  double sine = 1;
  for (int k = 18; k >= 2; k -= 2) {
    cosine = 1 - cosine * x2 / (k * (k - 1));
    sine = 1 - sine * x2 / (k * (k + 1));
  }
  sine *= x;
  return is_wide ? cosine / sine : sine / cosine;
}

/// The angle in [0, pi] whose cosine is x (clamped to [-1, 1]), within 3e-8 radians; the same bits
/// on every system. Based on: [AbramowitzStegun1964] 4.4.46.
[[nodiscard]] inline double arc_cosine(double x) {
  double a = x < 0 ? -x : x;
  if (!(a < 1)) a = 1;
  double sum = -0.0012624911;
  for (const double c : {0.0066700901, -0.0170881256, 0.0308918810, -0.0501743046, 0.0889789874,
                         -0.2145988016, 1.5707963050})
    sum = sum * a + c;
  const double angle = std::sqrt(1 - a) * sum;
  return x < 0 ? 3.14159265358979323846 - angle : angle;
}

}  // namespace varifold
