// Directions of the unit sphere in whole numbers, so that the side of a great circle on which a
// direction lies is known exactly.
//
// Based on: [Shewchuk1997] for the pattern of a filter in doubles before the exact sign.
// Differs: coordinates have 41 bits, so the exact determinant fits into 128 bits.
#pragma once

#include <varifold/base/math.h>
#include <cmath>
#include <cstdint>

namespace varifold {

/// A direction, not of exactly unit length. Coordinates are below 2^41 in magnitude: they, and
/// differences of two, are exact as doubles.
struct SpherePoint {
  std::int64_t x = 0, y = 0, z = 0;
  friend bool operator==(const SpherePoint&, const SpherePoint&) = default;
};

/// The length that directions are rounded at; neighbouring ones are about 1e-12 apart.
inline constexpr double kSphereRadius = 0x1.0p40;

/// The direction of `d`, which must be finite and not zero, in whole numbers.
[[nodiscard]] inline SpherePoint to_sphere_point(const DVec3& d) {
  const double scale = kSphereRadius / std::sqrt(glm::dot(d, d));
  return {std::llround(d.x * scale), std::llround(d.y * scale), std::llround(d.z * scale)};
}

/// About a unit vector.
[[nodiscard]] inline DVec3 direction(const SpherePoint& p) {
  constexpr double kScale = 1 / kSphereRadius;
  return {static_cast<double>(p.x) * kScale, static_cast<double>(p.y) * kScale,
          static_cast<double>(p.z) * kScale};
}

/// The determinant of three directions in units of 2^-120: its sign is exact, and it is right to
/// about 12 digits. Positive when a, b, c are counter-clockwise seen from outside; then they are
/// the corners of a triangle smaller than half the sphere.
[[nodiscard]] double determinant(const SpherePoint& a, const SpherePoint& b, const SpherePoint& c);

/// The sign alone: -1, 0 or 1.
[[nodiscard]] inline int orientation(const SpherePoint& a, const SpherePoint& b,
                                     const SpherePoint& c) {
  const double value = determinant(a, b, c);
  return (value > 0) - (value < 0);
}

}  // namespace varifold
