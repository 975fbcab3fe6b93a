// Whether a view can be asked at all.
#pragma once

#include <varifold/view/criteria.h>
#include <cmath>

namespace varifold {

/// Cameras that see nothing, and numbers that are none, ask for nothing. O(1).
[[nodiscard]] inline bool is_usable(const ViewCriterion& view) {
  const auto is_finite = [](const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  for (const Plane& plane : view.frustum.planes)
    if (!is_finite(plane.normal) || !std::isfinite(plane.offset)) return false;
  const float focal = view.scale.focal_pixels();
  return is_finite(view.eye) && std::isfinite(focal) && focal > 0;
}

}  // namespace varifold
