// Edges of a mesh in repair that join the same two points. Internal to this folder.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// How far copies of a point, and middles of edges, move apart: this part of the way to what is
/// around.
inline constexpr float kRepairNudge = 1e-3f;

/// Parts edges that hang together along one line but whose ends were not parted.
class DoubleEdges {
 public:
  /// Per corner `opposite` is that of the half-edge that begins there, kNone at holes, and
  /// `point_of` its point, kNone at those of which there is but one fan. `material_of` has one
  /// entry a triangle, and changes with them. All must outlive this.
  DoubleEdges(TriangleMesh& mesh, const std::vector<std::uint32_t>& opposite,
              const std::vector<std::uint32_t>& point_of, std::vector<std::uint32_t>& material_of)
      : mesh_(mesh), opposite_(opposite), point_of_(point_of), material_of_(material_of) {}

  /// Gives all edges but one that join two points a vertex in their middle; those of a border, too,
  /// where there is one. How many it were. O(n log n).
  std::uint32_t split(bool has_border);

 private:
  [[nodiscard]] const Vec3& opposite_corner(std::uint32_t half_edge) const;
  std::uint32_t add_middle(std::uint32_t half_edge, const Vec3& nudge);
  void cut_triangles(const std::vector<std::uint32_t>& middle_of);

  TriangleMesh& mesh_;
  const std::vector<std::uint32_t>& opposite_;
  const std::vector<std::uint32_t>& point_of_;
  std::vector<std::uint32_t>& material_of_;
};

}  // namespace varifold
