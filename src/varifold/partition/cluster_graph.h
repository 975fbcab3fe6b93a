// Clusters of triangles with their common borders: what greedy merging works on.
#pragma once

#include <varifold/base/large_vector.h>
#include <varifold/partition/edge_links.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

struct ClusterShape {
  float area = 0;     ///< where the longest side of the surface's box is 1
  float outline = 0;  ///< length of the border, in the same unit
  std::uint32_t triangles = 0;
  std::int32_t euler = 1;  ///< Euler characteristic: 1 where the cluster is a disc
};

/// That two clusters touch along edges, or, where they do not, that they may be merged all the
/// same.
struct ClusterLink {
  static constexpr std::uint32_t kRefused = 0x80000000u;

  std::uint32_t other = 0;
  float length = 0;         ///< of the common border; without one, minus the gap between the two
  std::uint32_t edges = 0;  ///< of the common border; kRefused: tried in vain while both were so

  [[nodiscard]] std::uint32_t edge_count() const { return edges & ~kRefused; }
  [[nodiscard]] bool refused() const { return edges & kRefused; }
};

/// A part of an array.
struct Row {
  std::uint32_t begin = 0, count = 0;
};

struct ClusterGraph {
  LargeVector<ClusterShape> shapes;
  LargeVector<Row> link_rows, point_rows;
  LargeVector<ClusterLink> links;  ///< one per neighbour
  /// The points on the border of a cluster, ascending, but for those that no other cluster has.
  LargeVector<std::uint32_t> points;
  LargeVector<std::uint32_t> clusters_at;  ///< per point: how many clusters have it on their border

  float unit = 1;  ///< model units per unit of length in shapes and links

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(shapes.size()); }
  [[nodiscard]] std::span<ClusterLink> links_of(std::uint32_t cluster) {
    return {links.data() + link_rows[cluster].begin, link_rows[cluster].count};
  }
  [[nodiscard]] std::span<const ClusterLink> links_of(std::uint32_t cluster) const {
    return {links.data() + link_rows[cluster].begin, link_rows[cluster].count};
  }
  [[nodiscard]] std::span<const std::uint32_t> points_of(std::uint32_t cluster) const {
    return {points.data() + point_rows[cluster].begin, point_rows[cluster].count};
  }
};

/// A triangle's cluster each, or kNone where it takes no part.
struct ClusterMap {
  std::span<const std::uint32_t> cluster_of;
  std::uint32_t count = 0;
};

/// The graph of the clusters; every euler is 1 yet. Borders of materials link clusters where
/// `across_materials`, else they are like open ones. O(n).
[[nodiscard]] ClusterGraph build_cluster_graph(const SurfaceView& surface, const EdgeLinks& links,
                                               const ClusterMap& map, bool across_materials,
                                               int threads);

/// The Euler characteristic of every cluster, counted from points, edges and triangles. O(n).
[[nodiscard]] std::vector<std::int32_t> euler_characteristics(const SurfaceView& surface,
                                                              const EdgeLinks& links,
                                                              const ClusterMap& map);

}  // namespace varifold
