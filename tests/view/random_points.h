// Random points and directions for the property tests of this folder.
#pragma once

#include <varifold/base/math.h>
#include <varifold/base/random.h>
#include <cmath>

namespace varifold::test {

inline float uniform(Random& random, float low, float high) {
  return low + (high - low) * static_cast<float>(random.uniform());
}

inline Vec3 point_in_cube(Random& random, float half_size) {
  const float x = uniform(random, -half_size, half_size);
  const float y = uniform(random, -half_size, half_size);
  return {x, y, uniform(random, -half_size, half_size)};
}

inline Vec3 point_in_ball(Random& random) {
  for (;;) {
    const Vec3 p = point_in_cube(random, 1);
    if (glm::dot(p, p) <= 1) return p;
  }
}

inline Vec3 unit_vector(Random& random) {
  for (;;) {
    const Vec3 p = point_in_ball(random);
    if (glm::length(p) > 0.1f) return glm::normalize(p);
  }
}

}  // namespace varifold::test
