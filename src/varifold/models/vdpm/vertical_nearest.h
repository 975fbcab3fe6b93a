// The point of a triangle of a height field above or below another point.
#pragma once

#include <varifold/simplify/star_triangles.h>
#include <algorithm>
#include <cmath>

namespace varifold {

/// Nearest points as the carrier of samples wants them, along an axis: of the triangles that have a
/// point above or below the origin that one; where none has, the point that is nearest in plan.
class VerticalNearest {
 public:
  explicit VerticalNearest(const Vec3& axis) : axis_(axis) {
    const Vec3 other = std::abs(axis.x) < 0.6f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    x_ = glm::normalize(glm::cross(other, axis));
    y_ = glm::cross(axis, x_);
  }

  void reset(const std::vector<StarTriangle>& triangles) { triangles_ = &triangles; }
  /// Mostly one of the triangles is above or below, and the others need no nearest point.
  std::size_t find(const Vec3& p, Vec3& way) const {
    for (std::size_t i = 0; i < triangles_->size(); ++i) {
      const std::array<Vec3, 3>& corners = (*triangles_)[i].corners;
      const NearestPoint nearest =
          on_triangle<true>(corners[0] - p, corners[1] - p, corners[2] - p);
      if (nearest.order != 0) continue;
      way = nearest.point;
      return i;
    }
    return find_among_all(p, way);
  }

 private:
  // Squared: nearer to an edge than this, the origin is taken to lie on it.
  static constexpr float kRounding = 1e-10f;

  std::size_t find_among_all(const Vec3& p, Vec3& way) const {
    std::size_t best = 0;
    NearestPoint nearest{Vec3(0), std::numeric_limits<float>::infinity()};
    for (std::size_t i = 0; i < triangles_->size(); ++i) {
      const std::array<Vec3, 3>& corners = (*triangles_)[i].corners;
      const NearestPoint other = on_triangle<false>(corners[0] - p, corners[1] - p, corners[2] - p);
      if (!(other.order < nearest.order)) continue;
      nearest = other;
      best = i;
      if (nearest.order == 0) break;  // a height field has but one above or below
    }
    way = nearest.point;
    return best;
  }

  static constexpr float kInfinity = std::numeric_limits<float>::infinity();

  // With `only_above`, anything that is not of order 0 may be infinitely far.
  template <bool only_above>
  [[nodiscard]] NearestPoint on_triangle(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const Vec3 p[3] = {in_plan(a), in_plan(b), in_plan(c)};
    float longest = 0, squared[3];  // lengths of edges
    float side[3];                  // twice the areas between the origin and the edges
    Vec3 along[3];
    for (int i = 0; i < 3; ++i) {
      along[i] = p[i == 2 ? 0 : i + 1] - p[i];
      side[i] = p[i].x * along[i].y - p[i].y * along[i].x;
      squared[i] = along[i].x * along[i].x + along[i].y * along[i].y;
      longest = std::max(longest, squared[i]);
    }
    const float area = side[0] + side[1] + side[2];
    const bool is_inside = area > 0 ? std::min({side[0], side[1], side[2]}) >= 0
                                    : area < 0 && std::max({side[0], side[1], side[2]}) <= 0;
    if (is_inside)
      return {(side[1] * p[0].z + side[2] * p[1].z + side[0] * p[2].z) / area * axis_, 0};
    if constexpr (only_above) {
      // Beyond the line of an edge by far more than roundings, the origin is not taken to lie on
      // it. Where they are greater than that, the triangle is too small and far away to hold it.
      const float sign = area > 0 ? 1.0f : -1.0f;
      for (int i = 0; i < 3; ++i)
        if (sign * side[i] < 0 && side[i] * side[i] > 4 * kRounding * longest * squared[i])
          return {Vec3(0), kInfinity};
    }
    NearestPoint best{Vec3(0), kInfinity};
    for (int i = 0; i < 3; ++i) {
      const float part =
          squared[i] > 0
              ? std::clamp(-(p[i].x * along[i].x + p[i].y * along[i].y) / squared[i], 0.0f, 1.0f)
              : 0.0f;
      const Vec3 at = p[i] + part * along[i];
      const float order = at.x * at.x + at.y * at.y;
      if (order < best.order) best = {at, order};
    }
    if (best.order <= kRounding * longest) return {best.point.z * axis_, 0};
    return {best.point.x * x_ + best.point.y * y_ + best.point.z * axis_, best.order};
  }

  [[nodiscard]] Vec3 in_plan(const Vec3& p) const {
    return {glm::dot(p, x_), glm::dot(p, y_), glm::dot(p, axis_)};
  }

  const std::vector<StarTriangle>* triangles_ = nullptr;
  Vec3 axis_, x_, y_;
};

}  // namespace varifold
