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
      const Vec3 a = corners[0] - p, b = corners[1] - p, c = corners[2] - p;
      if (is_far(a, b, c)) continue;
      const NearestPoint nearest = on_triangle(a, b, c);
      if (nearest.order != 0) continue;
      way = nearest.point;
      return i;
    }
    return find_among_all(p, way);
  }

 private:
  // Squared: nearer to an edge than this, the origin is taken to lie on it.
  static constexpr float kRounding = 1e-10f;

  // Whether the origin surely is neither in the triangle nor taken to lie on its edges: it is
  // beyond the line of an edge, and that by far more than roundings. Where these are greater than
  // that, the triangle is too small and too far away to hold the origin.
  [[nodiscard]] bool is_far(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const float x[3] = {glm::dot(a, x_), glm::dot(b, x_), glm::dot(c, x_)};
    const float y[3] = {glm::dot(a, y_), glm::dot(b, y_), glm::dot(c, y_)};
    float longest = 0, squared[3], side[3];  // as in on_triangle()
    for (int i = 0; i < 3; ++i) {
      const int next = i == 2 ? 0 : i + 1;
      const float along_x = x[next] - x[i], along_y = y[next] - y[i];
      side[i] = x[i] * along_y - y[i] * along_x;
      squared[i] = along_x * along_x + along_y * along_y;
      longest = std::max(longest, squared[i]);
    }
    const float sign = side[0] + side[1] + side[2] > 0 ? 1.0f : -1.0f;
    bool is_far = false;
    for (int i = 0; i < 3; ++i)
      is_far |= sign * side[i] < 0 && side[i] * side[i] > 4 * kRounding * longest * squared[i];
    return is_far;
  }

  std::size_t find_among_all(const Vec3& p, Vec3& way) const {
    std::size_t best = 0;
    NearestPoint nearest{Vec3(0), std::numeric_limits<float>::infinity()};
    for (std::size_t i = 0; i < triangles_->size(); ++i) {
      const std::array<Vec3, 3>& corners = (*triangles_)[i].corners;
      const NearestPoint other = on_triangle(corners[0] - p, corners[1] - p, corners[2] - p);
      if (!(other.order < nearest.order)) continue;
      nearest = other;
      best = i;
      if (nearest.order == 0) break;  // a height field has but one above or below
    }
    way = nearest.point;
    return best;
  }

  [[nodiscard]] NearestPoint on_triangle(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const Vec3 p[3] = {in_plan(a), in_plan(b), in_plan(c)};
    NearestPoint best{Vec3(0), std::numeric_limits<float>::infinity()};
    float longest = 0;  // squared
    float side[3];      // twice the areas between the origin and the edges
    for (int i = 0; i < 3; ++i) {
      const Vec3& from = p[i];
      const Vec3 along = p[(i + 1) % 3] - from;
      side[i] = from.x * along.y - from.y * along.x;
      const float squared = along.x * along.x + along.y * along.y;
      longest = std::max(longest, squared);
      const float part =
          squared > 0 ? std::clamp(-(from.x * along.x + from.y * along.y) / squared, 0.0f, 1.0f)
                      : 0.0f;
      const Vec3 at = from + part * along;
      const float order = at.x * at.x + at.y * at.y;
      if (order < best.order) best = {at, order};
    }
    const float area = side[0] + side[1] + side[2];
    const bool is_inside = area > 0 ? std::min({side[0], side[1], side[2]}) >= 0
                                    : area < 0 && std::max({side[0], side[1], side[2]}) <= 0;
    if (is_inside)
      return {(side[1] * p[0].z + side[2] * p[1].z + side[0] * p[2].z) / area * axis_, 0};
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
