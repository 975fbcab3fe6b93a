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
  /// Those that are held always take none in, either. Of a disc that a fan about one more vertex
  /// closes, let them be the boundary and that vertex, and no other edge join two of these. Then
  /// this gets down to one vertex inside: there is always an edge of two others to collapse, any,
  /// or one within the innermost triangle around that is none of the mesh.
  bool bars_targets = false;
  std::uint32_t late = 4;  ///< all free ones go first until so many vertices are left
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

}  // namespace varifold
