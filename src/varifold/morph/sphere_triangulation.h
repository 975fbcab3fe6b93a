// A triangulation of the sphere with its half-edges, and where in it a direction lies.
//
// The half-edge 3 t + k of triangle t goes from its corner k to the next one.
#pragma once

#include <varifold/base/math.h>
#include <varifold/morph/sphere_point.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// The next half-edge of its triangle.
[[nodiscard]] inline std::uint32_t next_half_edge(std::uint32_t half_edge) {
  return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
}

struct SphereTriangulation {
  std::vector<std::uint32_t> indices;
  std::vector<SpherePoint> points;
  std::vector<std::uint32_t> opposite;  ///< per half-edge, the same edge in the other triangle
  /// Per half-edge its edge; edges are numbered by the lower of their half-edges.
  std::vector<std::uint32_t> edge_of;
  std::vector<std::uint32_t> edge_half;  ///< per edge, that lower half-edge

  /// `indices` must be a closed oriented manifold. O(n log n).
  SphereTriangulation(std::vector<std::uint32_t> triangle_indices,
                      std::vector<SpherePoint> vertex_points);

  [[nodiscard]] std::uint32_t from(std::uint32_t half_edge) const { return indices[half_edge]; }
  [[nodiscard]] std::uint32_t to(std::uint32_t half_edge) const {
    return indices[next_half_edge(half_edge)];
  }
  /// Whether the half-edge is the one that its edge is numbered by.
  [[nodiscard]] bool is_first(std::uint32_t half_edge) const {
    return edge_half[edge_of[half_edge]] == half_edge;
  }
  [[nodiscard]] std::uint32_t edge_count() const {
    return static_cast<std::uint32_t>(edge_half.size());
  }
};

/// Where directions lie in a triangulation that covers the sphere once: from a triangle near by.
class SphereLocator {
 public:
  explicit SphereLocator(const SphereTriangulation& triangulation);

  /// A triangle with no edge that `point` is strictly outside of, found by walking from
  /// `start`; kNone where the triangulation does not cover the sphere. O(triangles on the way).
  [[nodiscard]] std::uint32_t locate(const SpherePoint& point, std::uint32_t start) const;

 private:
  const SphereTriangulation& sphere_;
};

/// locate() for all points of `others`, each beginning at that of a neighbour. O(n) as a rule.
[[nodiscard]] std::vector<std::uint32_t> locate_vertices(const SphereTriangulation& others,
                                                         const SphereTriangulation& within);

}  // namespace varifold
