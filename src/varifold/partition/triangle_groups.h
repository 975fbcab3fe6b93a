// Triangles that belong together before any merging: those around edges with three or more faces.
#pragma once

#include <varifold/partition/edge_links.h>
#include <varifold/partition/surface_view.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// Disjoint sets of triangles.
struct TriangleGroups {
  std::vector<std::uint32_t> group_of;  ///< per triangle; kNone: by itself. Empty: all are
  std::uint32_t count = 0;

  [[nodiscard]] std::uint32_t of(std::uint32_t triangle) const {
    return group_of.empty() ? kNone : group_of[triangle];
  }
};

/// Glues the triangles with a corner on a chain of non-manifold edges, one group per chain and
/// material, so that no border of patches meets such an edge. Chains whose triangles overlap become
/// one as long as the group has at most `max_triangles`; a chain that has more is left alone.
/// O(1) without non-manifold edges, else O(n).
[[nodiscard]] TriangleGroups glue_nonmanifold_stars(const SurfaceView& surface,
                                                    const EdgeLinks& links,
                                                    std::uint32_t max_triangles);

}  // namespace varifold
