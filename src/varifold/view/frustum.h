// The volume that a camera sees, and what of it a sphere or box may touch.
#pragma once

#include <varifold/base/math.h>
#include <varifold/view/camera.h>
#include <varifold/view/sphere.h>
#include <array>

namespace varifold {

/// What is known of a set against a volume. Only kOutside and kInside are certain: a set near a
/// corner of the volume may be told to intersect though it is outside.
enum class Containment { kOutside, kIntersects, kInside };

/// The set of points x with dot(normal, x) + offset >= 0; the normal has length 1.
struct Plane {
  Vec3 normal{0, 0, 1};
  float offset = 0;

  [[nodiscard]] float signed_distance(const Vec3& point) const {
    return glm::dot(normal, point) + offset;
  }
};

/// Six planes that look inwards.
struct Frustum {
  enum Side { kLeft, kRight, kBottom, kTop, kNear, kFar, kSideCount };
  std::array<Plane, kSideCount> planes;
};

/// The frustum of a usable camera, built from the eye and the axes rather than from the matrix, so
/// that the side planes pass through the eye exactly as far as float allows.
[[nodiscard]] Frustum frustum_of(const Camera& camera);

[[nodiscard]] bool contains(const Frustum& frustum, const Vec3& point);
/// An empty sphere is outside.
[[nodiscard]] Containment classify(const Frustum& frustum, const Sphere& sphere);
/// An empty box is outside.
[[nodiscard]] Containment classify(const Frustum& frustum, const Box& box);

}  // namespace varifold
