// Normals of triangles and vertices.
#pragma once

#include <varifold/mesh/topology.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/mesh/weld.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// Half the cross product of two edges: its direction is the triangle's normal, its length the
/// area. Zero for a degenerate triangle. No overflow for any finite positions.
[[nodiscard]] DVec3 area_vector(const TriangleMesh& mesh, std::uint32_t triangle);

/// Unit normal of a triangle, or zero where it is degenerate.
[[nodiscard]] Vec3 face_normal(const TriangleMesh& mesh, std::uint32_t triangle);

/// Unit normals of all triangles, zero where degenerate. O(triangles), in parallel.
[[nodiscard]] std::vector<Vec3> face_normals(const TriangleMesh& mesh, int threads = 0);

/// Area of a triangle, in squared model units.
[[nodiscard]] double triangle_area(const TriangleMesh& mesh, std::uint32_t triangle);

/// Sum of the areas of all triangles. O(triangles).
[[nodiscard]] double surface_area(const TriangleMesh& mesh);

/// Volume that a closed surface encloses, positive when its triangles are counter-clockwise seen
/// from outside; without meaning for an open one. O(triangles).
[[nodiscard]] double signed_volume(const TriangleMesh& mesh);

enum class NormalWeight {
  kAngle,  ///< by the angle of the triangle at the vertex: does not depend on the triangulation
  kArea,   ///< by the area of the triangle: faster
};

struct NormalOptions {
  NormalWeight weight = NormalWeight::kAngle;
  /// Edges whose triangles' normals differ by more than this stay sharp: their vertices are split.
  /// 180 or more: everything is smooth and no vertex is split.
  float crease_degrees = 180;
  int threads = 0;  ///< 0 = all
};

/// Sets the vertex normals from the triangles around each position class, so that normals agree
/// across seams of other attributes.
///
/// With a crease angle the triangles around a class fall into groups, joined across edges with
/// exactly two triangles whose normals differ by no more than the angle; a vertex used by several
/// groups is split: the first group keeps it, the others get copies at the end of the vertex
/// buffer. Every normal is a unit vector: where the weighted sum is zero it is that of the first
/// triangle with an area, or (0, 0, 1). Indices must be valid. O(n log valence); the same bytes
/// for any number of threads. Based on: [ThuermerWuethrich1998].
void compute_normals(TriangleMesh& mesh, const NormalOptions& options = {});

/// The same where the position classes are known already.
void compute_normals(TriangleMesh& mesh, const WeldMap& weld, const NormalOptions& options = {});

}  // namespace varifold
