// From a closed surface of genus 0 down to a tetrahedron, for what needs its topology alone.
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

}  // namespace varifold
