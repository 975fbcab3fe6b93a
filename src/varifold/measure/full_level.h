// Private to this folder: the full level of a model, and what no level or front may lose of it.
#pragma once

#include <varifold/measure/check_parts.h>
#include <varifold/mesh/topology.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold::check {

class FullLevel {
 public:
  FullLevel() = default;
  /// `mesh` is what is drawn; `triangles` are those that all levels come from. Positions were
  /// rounded by at most `rounding`.
  FullLevel(TriangleMesh mesh, std::vector<CanonicalTriangle> triangles, const ModelPoints& points,
            double rounding, int threads);

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  /// Whether it has triangles on a line, or a level that was noted has.
  [[nodiscard]] bool may_have_zero_area() const { return has_zero_area_; }
  void note_level(const TriangleMesh& mesh);

  /// The triangles must be the full ones with every vertex replaced by its ancestor, less those
  /// with two corners at one point: wrong_corner, lost_triangle, doubled_triangle. O(n log n).
  void check_corners(const TriangleMesh& mesh, std::span<const std::uint32_t> ancestor,
                     std::span<const std::uint32_t> point_of, PlaceFaults& faults,
                     std::uint32_t place) const;
  /// Topology and orientation, on the points that `weld` tells: not_closed, euler_changed,
  /// components_changed, degenerate_triangle, new_duplicate_triangle, new_nonmanifold_edge,
  /// new_misoriented_edge, flipped_triangle. O(n log n).
  void check_surface(const TriangleMesh& mesh, const WeldMap& weld, PlaceFaults& faults,
                     std::uint32_t place) const;

 private:
  [[nodiscard]] std::size_t flipped_beyond_rounding(const TriangleMesh& mesh) const;

  TriangleMesh mesh_;
  std::vector<CanonicalTriangle> triangles_;
  TopologyReport topology_;
  bool has_zero_area_ = false;
  double thin_ = 0;
  int threads_ = 0;
};

}  // namespace varifold::check
