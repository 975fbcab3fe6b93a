// From a closed surface of genus 0 down to a tetrahedron, or from a disc down to a cone, for what
// needs its topology alone.
#pragma once

#include <varifold/base/math.h>
#include <varifold/morph/ring_mesh.h>
#include <varifold/morph/sphere_point.h>
#include <cstdint>
#include <span>

namespace varifold {

/// When a vertex may go.
enum class Hold : std::uint8_t {
  kFree,
  kLate,   ///< when so few are left that DecimationOptions::late says so
  kAlways  ///< not at all
};

struct DecimationOptions {
  std::uint32_t least = 4;      ///< vertices to leave, 4 or more
  std::span<const Hold> holds;  ///< empty, or one for each vertex
  std::uint32_t late = 4;       ///< all free ones go first until so many vertices are left
  bool onto_held = true;        ///< whether others may go onto those that are always held
  /// Directions of the vertices that a positive triangulation of the sphere is to remain with;
  /// empty: none.
  std::span<const SpherePoint> points;
};

/// Collapses edges, cheapest first, until as many vertices are left as wanted; `mesh` is that then.
///
/// Any triangulation of the sphere but the tetrahedron has an edge that may be collapsed, so
/// without holds and directions this always gets there. The order keeps the shape by quadrics and
/// prefers short edges and vertices of low valence; nothing about shape forbids a collapse, unlike
/// in simplify(), whose levels are to be looked at. O(n log n).
[[nodiscard]] CollapseRecord decimate(RingMesh& mesh, std::span<const Vec3> positions,
                                      const DecimationOptions& options = {});

/// All the way, with nothing held.
[[nodiscard]] inline CollapseRecord decimate_to_tetrahedron(RingMesh& mesh,
                                                            std::span<const Vec3> positions) {
  return decimate(mesh, positions);
}

/// The same for a disc that a fan about one more vertex closes: `is_fixed` says for every vertex
/// whether it is of the boundary or that one, and these stay, until one other is left.
///
/// No edge inside may join two of the boundary. Then there is always an edge of two others that may
/// be collapsed: of any, or of those within the innermost triangle around that is none of the mesh.
[[nodiscard]] CollapseRecord decimate_to_cone(RingMesh& mesh, std::span<const Vec3> positions,
                                              const std::vector<bool>& is_fixed);

}  // namespace varifold
