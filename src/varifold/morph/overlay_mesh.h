// From the cells of an overlay to a mesh with both shapes and their attributes.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/morph/overlay.h>
#include <varifold/morph/overlay_reduction.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// One of the two surfaces: its mesh, the map of its points (position classes) onto the sphere,
/// and for each triangle of that the triangle of the mesh, whose corners are in the same order. Of
/// discs the map goes on with the fan that closes it.
struct MappedSurface {
  const TriangleMesh& mesh;
  const SphereTriangulation& sphere;
  const std::vector<std::uint32_t>& triangles;
};

/// The mesh of the cells, each cut into a fan. Positions are places on a, pose 0 has those on b;
/// a point within a flat triangle has its place by the triangle's flat image on the sphere, so
/// that both surfaces are met exactly up to the rounding of floats. Normals, texture coordinates,
/// colours and materials are those of a, the normals of the pose those of b where both have
/// normals. Points are the
/// nodes of the cells; a vertex for each combination of wedges (seams of either). Of discs, the
/// boundary gets a fan with vertices of its own. O(cells).
[[nodiscard]] OverlayTriangles make_overlay_mesh(const MappedSurface& a, const MappedSurface& b,
                                                 const Crossings& crossings,
                                                 const OverlayCells& cells);

}  // namespace varifold
