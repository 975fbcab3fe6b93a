// Directions between which the normals of a triangle lie in all blends of its shapes.
#pragma once

#include <varifold/base/math.h>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Appends units, or zero where there is no direction.
///
/// With weights w_i >= 0 of the shapes, the normal of the triangle in the blend, as long as twice
/// its area, is sum_ij w_i w_j N_ij, where N_ij is half the sum of e_i x f_j and e_j x f_i for its
/// edges e and f in the shapes i and j. So a cone of less than 90 degrees that holds all N_ij holds
/// it. Of one shape alone it is the normal. O(shapes^2).
inline void blended_normals(std::span<const std::span<const Vec3>> shapes,
                            const std::array<std::uint32_t, 3>& corners,
                            std::vector<Vec3>& normals) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Vec3 e = shapes[i][corners[1]] - shapes[i][corners[0]];
    const Vec3 f = shapes[i][corners[2]] - shapes[i][corners[0]];
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 other_e = shapes[j][corners[1]] - shapes[j][corners[0]];
      const Vec3 other_f = shapes[j][corners[2]] - shapes[j][corners[0]];
      normals.push_back(normalize_or_zero(glm::cross(e, other_f) + glm::cross(other_e, f)));
    }
    normals.push_back(normalize_or_zero(glm::cross(e, f)));
  }
}

}  // namespace varifold
