// Mends what keeps a mesh from being a sphere or a disc, as far as that is simple.
#pragma once

#include <varifold/base/result.h>
#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>

namespace varifold {

struct RepairOptions {
  /// Holes with more edges stay open.
  std::uint32_t max_hole_edges = 1000;
  /// Handles with a longer way around them are left: a part of the diagonal of the box.
  float max_handle = 0.05f;
  /// For a disc: the longest hole stays open whatever its size, if there is one. Then handles are
  /// not cut, and which side is outside is left as it is.
  bool keep_longest_hole = false;
};

/// What was done; all zero for a sphere.
struct RepairReport {
  std::uint32_t dropped_triangles = 0;  ///< without three places, or doubled
  std::uint32_t cut_edges = 0;          ///< where triangles were parted: with three or more of them
  std::uint32_t split_points = 0;       ///< copies of points where several fans touched
  std::uint32_t dropped_components = 0;
  std::uint32_t component_triangles = 0;  ///< of the components dropped
  std::uint32_t closed_holes = 0;
  std::uint32_t new_triangles = 0;  ///< that close them
  std::uint32_t cut_handles = 0;
  bool turned = false;           ///< it was inside out: all triangles were turned
  std::uint32_t open_edges = 0;  ///< of the hole that was kept; this is no change
  /// Its length in proportion to that of a circle around the same area as the surface has: 1 for a
  /// flat disc, 0.7 for half a sphere, more for what is long or jagged.
  double openness = 0;

  [[nodiscard]] bool changed() const {
    return dropped_triangles + cut_edges + split_points + dropped_components + closed_holes +
                   cut_handles >
               0 ||
           turned;
  }
};

struct RepairedSphere {
  TriangleMesh mesh;
  RepairReport report;
};

/// Makes a closed oriented manifold of one component of a mesh that nearly is one.
///
/// Triangles with two corners at one place, and those on the same side of the same three points as
/// another one, are dropped. At edges with more than two triangles the smoothest
/// pairs stay together, and points where several fans touch become one for each, a thousandth
/// of an edge apart. The component with the most triangles stays; its holes are closed by fans
/// about their middles. Attributes and materials are kept; those of new vertices are means. Poses
/// and skins are dropped. Small handles, as touching sheets leave them, are cut and closed like
/// holes. Greater ones are left; so are single turned triangles, as holes at most. A surface that
/// is inside out is turned, with its normals: two that are not alike would morph into mirror
/// images. Errors: kInvalidInput where indices or sizes of arrays are wrong, or nothing is left.
/// O(n log n). With `keep_longest_hole` the surface has one hole after that, if it had one before.
///
/// Based on: [GueziecTaubinLazarusHorn2001] for cutting and stitching.
[[nodiscard]] Result<RepairedSphere> repair_to_sphere(const TriangleMesh& mesh,
                                                      const RepairOptions& options = {});

}  // namespace varifold
