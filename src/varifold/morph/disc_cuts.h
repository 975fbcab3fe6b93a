// Discs with more vertices on their edges: the same shape, but one that fits onto half a sphere.
// Internal to this folder.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/morph/sphere_surface.h>
#include <cstdint>
#include <span>

namespace varifold {

/// A disc of which mesh and surface have the same triangles in the same order.
struct DiscMesh {
  TriangleMesh mesh;
  SphereSurface surface;
};

/// The disc of a mesh that `surface` was made of; without poses, skin and unused triangles.
/// Vertices and points keep their numbers. O(n).
[[nodiscard]] DiscMesh to_disc_mesh(const TriangleMesh& mesh, SphereSurface surface);

/// A new vertex on an edge.
struct EdgeCut {
  std::uint32_t half_edge = 0;  ///< 3 t + k of the surface, from corner k of triangle t
  std::uint32_t opposite = 0;   ///< the half-edge that runs against it; kNone at the boundary
  double at = 0;                ///< the part of the way along the half-edge, between 0 and 1
};

/// Cuts edges; the new points have the numbers from surface.positions.size() on, in the order of
/// `cuts`. New vertices have blended attributes, one for each side of a seam. An edge may be cut
/// several times only where the two other edges of its triangles are not cut. Triangles are cut
/// into fans, about the corner across where one edge is cut alone. O(n log n).
void cut_edges(DiscMesh& disc, std::span<const EdgeCut> cuts);

/// Cuts every edge inside that joins two points of the boundary in its middle, so that no triangle
/// has three of those unless the disc is one triangle. O(n log n).
void cut_chords(DiscMesh& disc);

}  // namespace varifold
