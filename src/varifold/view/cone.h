// Normal cones: the set of normals of a piece of surface, to tell when all of it looks away.
//
// Based on: [Hoppe1997] section 4, surface orientation.
// Differs: the paper treats the region as a point, which is unsafe close up; here the region's
// bounding sphere widens the cone by the angle under which the eye sees its radius.
#pragma once

#include <varifold/base/math.h>
#include <varifold/view/sphere.h>
#include <algorithm>
#include <cmath>
#include <span>

namespace varifold {

/// All unit vectors within an angle of `axis`. The default cone holds every direction, which is
/// always safe. Only cones of less than 90 degrees can tell anything.
struct NormalCone {
  Vec3 axis{0, 0, 1};  ///< length 1
  float cosine = -1;   ///< of the angle
  float sine = 0;      ///< of the angle; stored, so that the tests need no trigonometry
  [[nodiscard]] bool is_wide() const { return cosine <= 0; }
};

/// How a piece of surface is turned towards the eye. kFront and kBack are certain for every
/// point and normal of the piece.
enum class Facing { kFront, kBack, kMixed };

/// The cone around an axis that holds the given unit normals, with the axis along their sum. Not
/// the smallest cone, but never too small. Zero normals are left out; none at all gives the cone of
/// every direction. O(normals).
[[nodiscard]] inline NormalCone cone_around(std::span<const Vec3> normals) {
  Vec3 sum(0);
  for (const Vec3& n : normals) sum += n;
  NormalCone cone;
  const Vec3 axis = normalize_or_zero(sum);
  if (axis == Vec3(0)) return cone;
  float cosine = 1;
  for (const Vec3& n : normals)
    if (n != Vec3(0)) cosine = std::min(cosine, glm::dot(axis, n));
  // Rounding of the products must not leave a normal outside.
  cone.axis = axis;
  cone.cosine = std::max(-1.0f, cosine - 1e-6f);
  cone.sine = std::sqrt(std::max(0.0f, 1 - cone.cosine * cone.cosine));
  return cone;
}

/// Judges a piece inside `ball` with normals inside `cone`, seen from `eye`. O(1), no
/// trigonometry: with b the angle of the ball's radius seen from the eye, the piece faces away
/// when the angle between the axis and the line of sight is below 90 degrees - angle - b.
[[nodiscard]] inline Facing facing(const NormalCone& cone, const Sphere& ball, const Vec3& eye) {
  const Vec3 ray = ball.center - eye;
  const float distance = glm::length(ray);
  if (cone.is_wide() || distance <= ball.radius) return Facing::kMixed;
  const float sine_b = std::max(ball.radius, 0.0f) / distance;
  const float cosine_b = std::sqrt(std::max(0.0f, 1 - sine_b * sine_b));
  const float cosine_sum = cone.cosine * cosine_b - cone.sine * sine_b;
  if (cosine_sum <= 0) return Facing::kMixed;
  const float sine_sum = cone.sine * cosine_b + cone.cosine * sine_b;
  const float along = glm::dot(cone.axis, ray) / distance;
  constexpr float kRounding = 1e-6f;
  if (along > sine_sum + kRounding) return Facing::kBack;
  if (along < -sine_sum - kRounding) return Facing::kFront;
  return Facing::kMixed;
}

[[nodiscard]] inline bool is_back_facing(const NormalCone& cone, const Sphere& ball,
                                         const Vec3& eye) {
  return facing(cone, ball, eye) == Facing::kBack;
}

}  // namespace varifold
