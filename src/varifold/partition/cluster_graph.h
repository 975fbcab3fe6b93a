// Clusters of triangles with their common borders: what greedy merging works on.
#pragma once

#include <varifold/base/large_vector.h>
#include <varifold/partition/edge_links.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

struct ClusterShape {
  float area = 0;     ///< in squares of the unit of length
  float outline = 0;  ///< length of the border
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
  /// The points on the border of a cluster, ascending; those that no other cluster has may lack.
  LargeVector<std::uint32_t> points;
  LargeVector<std::uint32_t> clusters_at;  ///< per point: how many clusters have it, or empty

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

/// The clusters of the triangles from `first` on; kNone where a triangle takes no part. All others
/// are like those that take none.
struct ClusterMap {
  std::span<const std::uint32_t> cluster_of;
  std::uint32_t count = 0;
  std::uint32_t first = 0;
};

struct GraphOptions {
  bool across_materials = false;  ///< else borders of materials are like open ones
  /// Whether points that no other cluster has are to be found, which takes 4 B per point of the
  /// surface.
  bool count_clusters_at = true;
  float unit = 1;  ///< see length_unit()
  /// Per cluster, where they are known: the area, in squares of the unit.
  std::span<const float> areas = {};
  int threads = 0;
};

/// Model units per unit of length in a graph, so that no square of a length runs over or vanishes:
/// the longest side of the box. O(points).
[[nodiscard]] float length_unit(const SurfaceView& surface);

/// The graph of the clusters; every euler is 1 yet. O(triangles of the map).
[[nodiscard]] ClusterGraph build_cluster_graph(const SurfaceView& surface, const EdgeLinks& links,
                                               const ClusterMap& map, const GraphOptions& options);

/// The Euler characteristic of every cluster, counted from points, edges and triangles. O(n).
[[nodiscard]] std::vector<std::int32_t> euler_characteristics(const SurfaceView& surface,
                                                              const EdgeLinks& links,
                                                              const ClusterMap& map);

}  // namespace varifold
