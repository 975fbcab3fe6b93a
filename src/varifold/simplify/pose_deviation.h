// How far a mesh that takes several shapes is from its levels, in all blends of them.
#pragma once

#include <varifold/base/math.h>
#include <varifold/simplify/collapse_sequence.h>
#include <varifold/simplify/star_triangles.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// The places of all vertices in all shapes, those of a vertex side by side; the shape at rest is
/// the first. 12 bytes a vertex and shape.
class ShapeTable {
 public:
  explicit ShapeTable(const DetailedMesh& detailed);
  [[nodiscard]] std::size_t shape_count() const { return count_; }
  [[nodiscard]] std::span<const Vec3> of(std::uint32_t vertex) const {
    return {&places_[vertex * count_], count_};
  }

 private:
  std::vector<Vec3> places_;
  std::size_t count_;
};

/// The triangle to which a vertex goes, and a bound on its distance that holds in every blend.
///
/// In shape i the vertex is at P_i, and the nearest point of the triangle has the weights b_i. In
/// the blend with the weights w_i >= 0, which sum up to 1, it is compared with the point of the
/// triangle that has the weights sum w_j b_j. The way between the two is
/// sum_ij w_i w_j (P_i - S_i b_j), where S_i takes weights to places: a mean of the ways
/// 1/2 (P_i - S_i b_j + P_j - S_j b_i), so that it is no longer than the longest of these, which is
/// the bound. With weights that are not all positive, multiply by the square of the sum of |w_i|.
class NearestInShapes {
 public:
  /// `corners` has three vertices a triangle, those of the level. Both must live on.
  NearestInShapes(const ShapeTable& shapes, const std::vector<std::uint32_t>& corners)
      : shapes_(shapes), corners_(corners), weights_(shapes.shape_count()) {}

  /// The triangles, at least one. They must live on.
  void reset(const std::vector<StarTriangle>& triangles) { triangles_ = &triangles; }
  /// The number of the triangle whose greatest distance in any shape is least, the first of those
  /// at equal distances. bound() is that of the vertex then. O(shapes * (triangles + shapes)).
  std::size_t find(std::uint32_t vertex);
  [[nodiscard]] float bound() const { return bound_; }

 private:
  struct CornerPlaces {
    std::span<const Vec3> a, b, c;
  };
  [[nodiscard]] CornerPlaces places(std::size_t number) const;
  [[nodiscard]] float greatest_distance(std::span<const Vec3> at, const CornerPlaces& corners,
                                        float enough) const;
  [[nodiscard]] float bound_of(std::span<const Vec3> at, const CornerPlaces& corners);

  const ShapeTable& shapes_;
  const std::vector<std::uint32_t>& corners_;
  const std::vector<StarTriangle>* triangles_ = nullptr;
  std::vector<Vec2> weights_;  // of b and c, in each shape
  float bound_ = 0;
};

}  // namespace varifold
