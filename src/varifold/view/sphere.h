// Bounding spheres: what the view-dependent criteria know of a piece of surface.
#pragma once

#include <varifold/base/math.h>

namespace varifold {

/// A closed ball; a negative radius stands for the empty set.
struct Sphere {
  Vec3 center{0};
  float radius = -1;

  [[nodiscard]] bool empty() const { return radius < 0; }
};

/// The ball through the corners of a box; empty for an empty box.
[[nodiscard]] inline Sphere sphere_around(const Box& box) {
  return box.empty() ? Sphere{} : Sphere{box.center(), 0.5f * box.diagonal()};
}

/// The distance from a point to the ball; 0 inside. The ball must not be empty.
[[nodiscard]] inline float distance_to(const Sphere& sphere, const Vec3& point) {
  const float gap = glm::length(sphere.center - point) - sphere.radius;
  return gap > 0 ? gap : 0.0f;
}

}  // namespace varifold
