// Small compact clusters to begin merging with: stars of points, and what is left between them.
#pragma once

#include <varifold/partition/edge_links.h>
#include <varifold/partition/surface_view.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// Numbers the triangles whose `cluster_of` is kNone by clusters, from `count` on; returns how many
/// clusters there are then. A cluster is all triangles around an inner point (four to eight) and
/// what is left beside them, ten at most, or what is left alone; it is a disc, of one material.
/// Other triangles are not touched. The same result for any number of threads. O(n).
[[nodiscard]] std::uint32_t seed_clusters(const SurfaceView& surface, const EdgeLinks& links,
                                          std::span<std::uint32_t> cluster_of, std::uint32_t count,
                                          int threads);

}  // namespace varifold
