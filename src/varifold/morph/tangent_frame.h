// Two directions across a third.
#pragma once

#include <varifold/base/math.h>
#include <cmath>
#include <utility>

namespace varifold {

/// Unit vectors u, v with u x v = n, for a unit vector n.
[[nodiscard]] inline std::pair<DVec3, DVec3> tangent_frame(const DVec3& n) {
  const DVec3 helper = std::abs(n.x) < 0.6 ? DVec3(1, 0, 0) : DVec3(0, 1, 0);
  const DVec3 u = glm::normalize(glm::cross(helper, n));
  return {u, glm::cross(n, u)};
}

}  // namespace varifold
