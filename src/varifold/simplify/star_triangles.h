// A few triangles, and the one of them that is nearest to each of many points.
#pragma once

#include <varifold/base/math.h>
#include <varifold/simplify/closest_on_triangle.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// A point of a triangle near the origin.
struct NearestPoint {
  Vec3 point;
  float order;  ///< less is nearer
};

/// The point of the triangle (a, b, c) that is nearest to the origin; `order` is the squared
/// distance.
[[nodiscard]] inline NearestPoint nearest_on_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 nearest = closest_on_triangle(a, b, c).position;
  return {nearest, glm::dot(nearest, nearest)};
}

/// A triangle with the places of its corners.
struct StarTriangle {
  std::uint32_t triangle;
  std::array<Vec3, 3> corners;
};

/// Some points, and what is nearest to each: the number of its triangle, and the way there.
struct NearestBatch {
  static constexpr std::size_t kSize = 8;
  alignas(32) float x[kSize], y[kSize], z[kSize];
  alignas(32) std::int32_t found[kSize];
  alignas(32) float way_x[kSize], way_y[kSize], way_z[kSize];
};

namespace star_triangles {

/// With vector instructions where the processor has them; and without. At least one triangle.
void find_nearest(std::span<const StarTriangle> triangles, NearestBatch& batch);
void find_nearest_plain(std::span<const StarTriangle> triangles, NearestBatch& batch);

}  // namespace star_triangles

/// Which of some triangles is nearest to a point, and where. The first of those at equal distances.
class NearestTriangle {
 public:
  /// The triangles, at least one. They must live on.
  void reset(const std::vector<StarTriangle>& triangles) { triangles_ = &triangles; }
  /// Its number, and the way from `p` to it. O(triangles).
  std::size_t find(const Vec3& p, Vec3& way) const {
    std::size_t best = 0;
    NearestPoint nearest = from(0, p);
    for (std::size_t i = 1; i < triangles_->size(); ++i) {
      const NearestPoint other = from(i, p);
      if (!(other.order < nearest.order)) continue;
      nearest = other;
      best = i;
    }
    way = nearest.point;
    return best;
  }
  /// The same for many points, to the bit.
  void find(NearestBatch& batch) const { star_triangles::find_nearest(*triangles_, batch); }

 private:
  [[nodiscard]] NearestPoint from(std::size_t i, const Vec3& p) const {
    const std::array<Vec3, 3>& corners = (*triangles_)[i].corners;
    return nearest_on_triangle(corners[0] - p, corners[1] - p, corners[2] - p);
  }

  const std::vector<StarTriangle>* triangles_ = nullptr;
};

}  // namespace varifold
