// From a closed surface of genus 0 down to a tetrahedron, or from a disc down to a cone, for what
// needs its topology alone.
#pragma once

#include <varifold/base/math.h>
#include <varifold/morph/ring_mesh.h>
#include <span>

namespace varifold {

/// Collapses edges, cheapest first, until a tetrahedron is left; `mesh` is that then.
///
/// Any triangulation of the sphere but the tetrahedron has an edge that may be collapsed, so this
/// always gets there. The order keeps the shape by quadrics and prefers short edges and vertices
/// of low valence; nothing about shape forbids a collapse, unlike in simplify(), whose levels are
/// to be looked at. O(n log n).
[[nodiscard]] CollapseRecord decimate_to_tetrahedron(RingMesh& mesh,
                                                     std::span<const Vec3> positions);

/// The same for a disc that a fan about one more vertex closes: `is_fixed` says for every vertex
/// whether it is of the boundary or that one, and these stay, until one other is left.
///
/// No edge inside may join two of the boundary. Then there is always an edge of two others that may
/// be collapsed: of any, or of those within the innermost triangle around that is none of the mesh.
[[nodiscard]] CollapseRecord decimate_to_cone(RingMesh& mesh, std::span<const Vec3> positions,
                                              const std::vector<bool>& is_fixed);

}  // namespace varifold
