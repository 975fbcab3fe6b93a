// Small compact clusters to begin merging with.
#pragma once

#include <varifold/partition/edge_links.h>
#include <varifold/partition/surface_view.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

struct SeedOptions {
  std::uint32_t triangles = 32;  ///< of a cluster, in the mean and roughly; twice as many at most
  std::uint32_t grow_to = 18;    ///< triangles of a seed; fewer than a star has: stars only
  float unit = 1;                ///< see length_unit()
  int threads = 0;
};

struct SeedClusters {
  std::uint32_t count = 0;   ///< with those that there were before
  std::vector<float> areas;  ///< of the new ones, in squares of the unit
};

/// Numbers the triangles whose `cluster_of` is kNone by clusters, from `count` on. Seeds are all
/// triangles around a point, some around those, and what is left between; they are merged as
/// MergeRounds does, but piece by piece of the triangles in their order. So clusters are discs of
/// one material, and none crosses from piece to piece. The same result for any number of threads.
/// O(n).
[[nodiscard]] SeedClusters seed_clusters(const SurfaceView& surface, const EdgeLinks& links,
                                         const SeedOptions& options,
                                         std::span<std::uint32_t> cluster_of, std::uint32_t count);

}  // namespace varifold
