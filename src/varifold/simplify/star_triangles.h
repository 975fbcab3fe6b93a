// A few triangles, and the one of them that is nearest to each of many points.
#pragma once

#include <varifold/base/math.h>
#include <varifold/simplify/closest_on_triangle.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
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

/// Which of some triangles is nearest to a point, and where. The first of those at equal distances.
///
/// Four planes stand around a triangle: its own and one on each edge, at right angles to it. Their
/// distances bound that of the triangle from below, four triangles at a time; the true distance is
/// then needed for one or two.
class NearestTriangle {
 public:
  /// The triangles, at least one. They must live on.
  void reset(const std::vector<StarTriangle>& triangles) {
    triangles_ = &triangles;
    groups_.resize((triangles.size() + kLanes - 1) / kLanes);
    bounds_.resize(groups_.size() * kLanes);
    origin_ = triangles[0].corners[0];
    for (std::size_t i = 0; i < bounds_.size(); ++i)
      groups_[i / kLanes].set(i % kLanes, triangles[std::min(i, triangles.size() - 1)], origin_);
  }
  /// Its number, and the way from `p` to it. O(triangles).
  std::size_t find(const Vec3& p, Vec3& way) {
    for (std::size_t g = 0; g < groups_.size(); ++g)
      groups_[g].bound(p - origin_, &bounds_[g * kLanes]);
    const std::size_t count = triangles_->size();
    std::size_t first = 0;
    for (std::size_t i = 1; i < count; ++i)
      if (bounds_[i] < bounds_[first]) first = i;
    std::size_t best = first;
    NearestPoint nearest = exact(first, p);
    for (std::size_t i = 0; i < count; ++i) {
      // Bounds are rounded, so that they have to be above by a little.
      if (i == first || bounds_[i] * kRounding > nearest.order) continue;
      const NearestPoint other = exact(i, p);
      if (!(other.order < nearest.order || (other.order == nearest.order && i < best))) continue;
      nearest = other;
      best = i;
    }
    way = nearest.point;
    return best;
  }

 private:
  static constexpr std::size_t kLanes = 4;
  static constexpr float kRounding = 0.999f;

  [[nodiscard]] NearestPoint exact(std::size_t i, const Vec3& p) const {
    const std::array<Vec3, 3>& corners = (*triangles_)[i].corners;
    return nearest_on_triangle(corners[0] - p, corners[1] - p, corners[2] - p);
  }

  struct Group {
    // The planes n.p = d; that of the triangle first, then those of the edges, n outwards.
    std::array<std::array<float, kLanes>, 4> x, y, z, d;
    // What the roundings of a distance from a plane may come to.
    std::array<float, kLanes> lost;

    void set(std::size_t lane, const StarTriangle& triangle, const Vec3& origin) {
      const Vec3 c[3] = {triangle.corners[0] - origin, triangle.corners[1] - origin,
                         triangle.corners[2] - origin};
      const Vec3 normal = normalize_or_zero(glm::cross(c[1] - c[0], c[2] - c[0]));
      set_plane(0, lane, normal, c[0]);
      float size = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 edge = c[(i + 1) % 3] - c[i];
        set_plane(i + 1, lane, normalize_or_zero(glm::cross(edge, normal)), c[i]);
        size = std::max(size, glm::dot(c[i], c[i]));
      }
      // Needles have a normal that means little: no bound for them.
      const float area = glm::length(glm::cross(c[1] - c[0], c[2] - c[0]));
      const float edges =
          std::max({glm::dot(c[1] - c[0], c[1] - c[0]), glm::dot(c[2] - c[0], c[2] - c[0]),
                    glm::dot(c[2] - c[1], c[2] - c[1])});
      lost[lane] =
          area > 1e-3f * edges ? 1e-6f * std::sqrt(size) : std::numeric_limits<float>::infinity();
    }
    void set_plane(std::size_t plane, std::size_t lane, const Vec3& n, const Vec3& point) {
      x[plane][lane] = n.x;
      y[plane][lane] = n.y;
      z[plane][lane] = n.z;
      d[plane][lane] = glm::dot(n, point);
    }
    void bound(const Vec3& p, float* squared) const {
      for (std::size_t i = 0; i < kLanes; ++i) {
        float distance[4];
        for (std::size_t plane = 0; plane < 4; ++plane)
          distance[plane] = x[plane][i] * p.x + y[plane][i] * p.y + z[plane][i] * p.z - d[plane][i];
        const float above = std::max(std::abs(distance[0]) - lost[i], 0.0f);
        const float beside =
            std::max(std::max(std::max(distance[1], distance[2]), distance[3]) - lost[i], 0.0f);
        squared[i] = above * above + beside * beside;
      }
    }
  };

  const std::vector<StarTriangle>* triangles_ = nullptr;
  Vec3 origin_{0};
  std::vector<Group> groups_;
  std::vector<float> bounds_;
};

}  // namespace varifold
