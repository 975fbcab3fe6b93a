// How far a mesh that takes several shapes is from its levels, in all blends of them.
#pragma once

#include <varifold/base/math.h>
#include <varifold/simplify/collapse_sequence.h>
#include <varifold/simplify/sample_carrier.h>
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

/// A point of the full mesh in all shapes.
class SampleShapes {
 public:
  explicit SampleShapes(const ShapeTable& shapes)
      : shapes_(shapes), between_(shapes.shape_count()) {}
  /// Of a vertex or of an edge; valid until the next call. O(shapes).
  [[nodiscard]] std::span<const Vec3> of(const SurfaceSample& sample) {
    const std::span<const Vec3> a = shapes_.of(sample.from);
    if (sample.from == sample.to) return a;
    const std::span<const Vec3> b = shapes_.of(sample.to);
    for (std::size_t i = 0; i < a.size(); ++i) between_[i] = a[i] + sample.part * (b[i] - a[i]);
    return between_;
  }

 private:
  const ShapeTable& shapes_;
  std::vector<Vec3> between_;
};

/// The triangle to which a point goes, and how far that is in every blend.
///
/// In shape i the point is at P_i, and the nearest point of the triangle has the weights b_i. In
/// the blend with the weights w_i >= 0, which sum up to 1, it is compared with the point of the
/// triangle that has the weights sum w_j b_j. The way between the two is
/// sum_ij w_i w_j (S_i b_j - P_i), where S_i takes weights to places: a mean of the ways
/// 1/2 (S_i b_j - P_i + S_j b_i - P_j). So it lies in every convex set that holds these, and is no
/// longer than the longest of them. With weights that are not all positive, the length grows by the
/// square of the sum of |w_i| at most.
class NearestInShapes {
 public:
  /// `corners` has three vertices a triangle, those of the level. Both must live on.
  NearestInShapes(const ShapeTable& shapes, const std::vector<std::uint32_t>& corners)
      : shapes_(shapes), corners_(corners), weights_(shapes.shape_count()) {}

  /// The triangles, at least one. They must live on.
  void reset(const std::vector<StarTriangle>& triangles) { triangles_ = &triangles; }
  /// The number of the triangle whose greatest distance in any shape is least, the first of those
  /// at equal distances. O(shapes * triangles).
  std::size_t find(std::span<const Vec3> at);

  /// visit(way) gets the ways from the point that was found last, as above. O(shapes^2).
  template <class Visit>
  void for_each_way(std::span<const Vec3> at, const Visit& visit) const {
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Vec3 a = found_.a[i] - at[i], ab = found_.b[i] - found_.a[i],
                 ac = found_.c[i] - found_.a[i];
      for (std::size_t j = 0; j <= i; ++j) {
        const Vec3 here = a + weights_[j].x * ab + weights_[j].y * ac;
        const Vec3 aj = found_.a[j];
        const Vec3 there =
            aj - at[j] + weights_[i].x * (found_.b[j] - aj) + weights_[i].y * (found_.c[j] - aj);
        visit(0.5f * (here + there));
      }
    }
  }
  /// The length of the longest.
  [[nodiscard]] float greatest_way(std::span<const Vec3> at) const;

 private:
  struct CornerPlaces {
    std::span<const Vec3> a, b, c;
  };
  [[nodiscard]] CornerPlaces places(std::size_t number) const;

  const ShapeTable& shapes_;
  const std::vector<std::uint32_t>& corners_;
  const std::vector<StarTriangle>* triangles_ = nullptr;
  CornerPlaces found_;
  std::vector<Vec2> weights_;  // of b and c, in each shape
};

}  // namespace varifold
