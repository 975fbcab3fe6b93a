// Wedges: the vertices of the input, one for each set of attributes at a point.
#pragma once

#include <varifold/base/math.h>
#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <vector>

namespace varifold {

class WorkingSurface;

/// Wedges are numbered point by point, so those of point p are [first[p], first[p + 1]). Where
/// every point has one wedge and there is one material, wedge and point are the same number, and
/// only `vertex_of` and `wedge_of_vertex` are filled: has_seams() is false.
struct WedgeTables {
  std::vector<std::uint32_t> vertex_of;        ///< per wedge: a vertex of the input
  std::vector<std::uint32_t> wedge_of_vertex;  ///< per vertex; kNone where no face uses it
  std::vector<std::uint32_t> first;            ///< per point, and one more
  std::vector<std::uint32_t> point_of;         ///< per wedge
  std::vector<std::uint32_t> corners;          ///< three wedges per face, updated by collapses
  std::vector<std::uint32_t> group_of;     ///< per wedge: the first wedge on its side of the charts
  std::vector<std::uint32_t> material_of;  ///< per face; empty where there is one material
  std::vector<std::uint32_t> target;       ///< per wedge, once its point has collapsed

  [[nodiscard]] bool has_seams() const { return !corners.empty(); }
  [[nodiscard]] std::uint32_t first_of(std::uint32_t point) const {
    return has_seams() ? first[point] : point;
  }
  [[nodiscard]] std::uint32_t count_of(std::uint32_t point) const {
    return has_seams() ? first[point + 1] - first[point] : 1;
  }
  /// The wedge of `face` at `point`, which must be one of its corners; with seams only.
  [[nodiscard]] std::uint32_t at_corner(std::uint32_t face, std::uint32_t point) const {
    const std::uint32_t* corner = &corners[3 * std::size_t{face}];
    if (point_of[corner[0]] == point) return corner[0];
    return point_of[corner[1]] == point ? corner[1] : corner[2];
  }
  [[nodiscard]] std::size_t bytes() const;
};

/// Merges vertices of a point that have equal attributes into one wedge, and fills the tables.
/// O(n); points with many wedges (over 1024) are not searched for equal ones.
[[nodiscard]] WedgeTables make_wedges(const TriangleMesh& mesh, const WorkingSurface& surface);

}  // namespace varifold
