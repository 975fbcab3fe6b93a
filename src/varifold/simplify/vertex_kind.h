// What a vertex is to the simplifier, and where it may go.
#pragma once

#include <cstdint>

namespace varifold {

/// Decided once, from the feature edges at a vertex. A feature edge is one with a face count other
/// than two, with two faces that disagree in orientation, or with two faces whose materials or
/// texture coordinates differ (a seam). Legal collapses keep the kinds of the vertices that stay.
enum class VertexKind : std::uint8_t {
  kManifold,     ///< no feature edge, one closed ring
  kBorder,       ///< two border edges (one face each), one fan
  kSeam,         ///< two seam edges, one closed ring
  kNonManifold,  ///< two edges of k faces each, k fans between them
  kCorner,       ///< any other number or mixture of feature edges, in one sheet
  kLocked,       ///< several sheets that share this vertex alone, or too many wedges
  kCount
};

inline constexpr int kVertexKindCount = static_cast<int>(VertexKind::kCount);

/// Names as in reports and JSON.
inline constexpr const char* kVertexKindNames[kVertexKindCount] = {
    "manifold", "border", "seam", "non_manifold", "corner", "locked"};

/// The edges along which a vertex of a kind may collapse.
enum class CollapseAlong : std::uint8_t { kNothing, kAnyEdge, kFeatureEdge };

/// What a vertex of a kind (row) may do, whatever the kind of the target: the edge decides, since
/// a feature edge ends only at vertices that have it too.
///   manifold:     onto any neighbour; its ring holds no feature that could be torn
///   border:       along the border, onto border vertices and corners
///   seam:         along the seam, both sides in one step
///   non-manifold: along the edge that its k sheets share, all sheets in one step
///   corner:       stays, others come to it
inline constexpr CollapseAlong kCollapseAlong[kVertexKindCount] = {
    CollapseAlong::kAnyEdge,     CollapseAlong::kFeatureEdge, CollapseAlong::kFeatureEdge,
    CollapseAlong::kFeatureEdge, CollapseAlong::kNothing,     CollapseAlong::kNothing};

}  // namespace varifold
