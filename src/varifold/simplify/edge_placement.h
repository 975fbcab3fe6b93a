// The best place for the vertex that an edge collapses to.
#pragma once

#include <varifold/simplify/legality.h>
#include <varifold/simplify/point_quadric.h>
#include <cstdint>

namespace varifold {

/// Two neighbours and the quadrics about them.
struct PlacementEdge {
  Vec3 from, onto;
  const PointQuadric& from_quadric;
  const PointQuadric& onto_quadric;
};

struct EdgePlacement {
  Vec3 position{0};
  float error = 0;   ///< quadric error there
  float weight = 0;  ///< area of both quadrics
};

/// Where the sum of both quadrics is least; the middle of the edge where that is not determined.
[[nodiscard]] EdgePlacement place_edge(const PlacementEdge& edge);

/// The position of `onto`, with the error there.
[[nodiscard]] EdgePlacement placement_at_end(const PlacementEdge& edge);

struct PlacedCollapse {
  std::uint32_t from, onto;
  Vec3 position;
  std::uint32_t input_normal;  ///< packed; that the merged point will have
};

/// As test_collapse(), for a collapse that moves both points to a new position.
[[nodiscard]] Refusal test_placed_collapse(WorkingSurface& surface, const PlacedCollapse& collapse,
                                           const LegalityOptions& options);

}  // namespace varifold
