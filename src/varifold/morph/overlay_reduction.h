// Makes an overlay as small as both of its shapes allow.
//
// Why not simplify() alone: an overlay is full of needles, which have next to no area but may be
// part of a spike. Ordered by quadrics such a one comes early, and a bound on the error stops the
// sequence there. Here a collapse that would err too much is passed over.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <functional>
#include <vector>

namespace varifold {

/// A mesh with one pose whose points (places of both shapes) are numbered.
struct OverlayTriangles {
  TriangleMesh mesh;
  std::vector<std::uint32_t> point_of_vertex;  ///< vertices of a point differ in attributes alone
  std::uint32_t point_count = 0;
  /// Of a disc: the last triangles are a fan of its boundary about this point, with vertices of
  /// their own. It stands for the border, is no part of the shapes, and is gone after a reduction.
  std::uint32_t pole = kNone;
  std::uint32_t fan_triangles = 0;
};

struct ReductionOptions {
  /// How far each shape may go from that of the input, as a part of the diagonal of its box. With 0
  /// only edges are collapsed whose ends are in one place on both shapes, but for rounding.
  double tolerance = 5e-5;
  /// Asked now and then with the part that is done; returning false ends it early.
  std::function<bool(float done)> progress;
};

struct ReductionReport {
  std::uint32_t merged_points = 0;   ///< of edges without a length on both shapes
  std::uint32_t removed_points = 0;  ///< by other collapses
};

/// Collapses edges onto one of their ends, cheapest errors first in a few passes.
///
/// The surface stays a closed manifold or a disc (link condition); the boundary, seams and borders
/// of materials collapse along themselves only. The boundary curve, too, moves by no more than the
/// tolerance. On both shapes a collapse moves the surface by no more than the
/// tolerance, all that it inherits from collapses before added up, judged at the vertex that goes
/// and along the new edges; turns no triangle by more than 75 degrees; and makes no needle
/// that is worse than those at hand. Vertices are those of the input; unused ones are dropped.
/// O(n) as a rule, one thread.
/// Based on: [Cohen1996] for collapsing whatever stays within a tolerance.
ReductionReport reduce_overlay(OverlayTriangles& overlay, const ReductionOptions& options);

}  // namespace varifold
