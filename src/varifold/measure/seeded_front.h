// Private to this folder: the fronts that checks ask for.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/common/front_model.h>
#include <array>
#include <cstdint>

namespace varifold::check {

struct SeededFront {
  const char* name = "";
  RefineCriteria criteria;
  AdaptOptions options;

  /// Asks for full detail somewhere on a triangle, deeper than `margin` within the place; without a
  /// budget, that is.
  [[nodiscard]] bool asks_for(const std::array<Vec3, 3>& triangle, float margin) const;
};

/// The fronts of small numbers are the full one, the base, and the full one again. All others are,
/// by turns, spheres, planes and views of all sorts, with tolerances and budgets, on or near the
/// surface of `full`; each depends on its number and the mesh alone. `full` has triangles, `base`
/// is the number of those that are always there. O(vertices).
[[nodiscard]] SeededFront seeded_front(const TriangleMesh& full, std::uint32_t base,
                                       std::uint32_t number);

}  // namespace varifold::check
