// Polygons of mesh files become triangles.
#pragma once

#include <varifold/io/imported_mesh.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Collects the polygons of a file as triangles of a mesh. While reading, every polygon is a fan
/// around its first corner; once the positions are known, cut_concave() cuts those anew whose fan
/// would leave the polygon.
class PolygonCollector {
 public:
  explicit PolygonCollector(TriangleMesh& mesh) : mesh_(&mesh) {}

  /// Appends a polygon of at least 3 corners as corners - 2 triangles.
  void add(std::span<const std::uint32_t> corners);
  /// Counts a polygon of fewer than 3 corners, which is dropped.
  void drop() { ++dropped_; }

  /// Cuts concave polygons by their ears, seen along Newell's normal. Needs all indices in range.
  /// O(corners^2) per polygon, up to a budget that is linear in the size of the mesh; polygons
  /// beyond it stay fans.
  void cut_concave();

  /// Appends what was cut and dropped to the warnings.
  void warn(ImportedMesh& imported) const;

 private:
  struct Fan {
    std::size_t first_index;  ///< in TriangleMesh::indices
    std::uint32_t triangles;
  };
  TriangleMesh* mesh_;
  std::vector<Fan> fans_;
  std::size_t dropped_ = 0;
  std::size_t uncut_ = 0;  ///< polygons that cross themselves, or were too costly: still fans
};

}  // namespace varifold
