// Places of one surface by their directions on its map.
#pragma once

#include <varifold/morph/sphere_triangulation.h>
#include <span>
#include <vector>

namespace varifold {

/// Of all triangles.
[[nodiscard]] double area_of(std::span<const std::uint32_t> indices,
                             std::span<const Vec3> positions);

class SurfaceLift {
 public:
  /// Both must outlive this.
  SurfaceLift(const SphereTriangulation& sphere, std::span<const Vec3> positions);

  [[nodiscard]] double area() const { return area_; }

  /// The place at a unit vector, to about nine digits; `triangle` is one near by, and the one that
  /// it lies in afterwards. O(triangles on the way).
  [[nodiscard]] DVec3 at(const DVec3& point, std::uint32_t& triangle) const;

 private:
  const SphereTriangulation& sphere_;
  std::span<const Vec3> positions_;
  std::vector<DVec3> directions_;
  double area_;
};

}  // namespace varifold
