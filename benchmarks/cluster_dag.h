// A cluster DAG, the peer of the patch tree: clusters of triangles, grouped, simplified and cut
// into clusters anew, level by level, with meshoptimizer doing the work.
//
// Based on: [KarisStubbeWihlidal2021], [Kapoulkine2025] (structure and numbers of its defaults).
// Differs: meshoptimizer 0.18 (Debian) has neither its partition of clusters, nor clusters of a
// least
//   size, nor locks per vertex, nor its permissive and sloppy ways out where a group is stuck:
//   grouping is our own (cluster_groups.h), all open borders of a group are locked, those of the
//   mesh included, and groups that are stuck stay as they are. Positions alone, no attributes.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/camera.h>
#include <varifold/view/sphere.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold::bench {

struct ClusterDagOptions {
  std::uint32_t max_triangles = 128;  ///< of a cluster
  std::uint32_t max_vertices = 128;   ///< of a cluster
  std::uint32_t group_clusters = 16;  ///< wanted in a group
  float ratio = 0.5f;                 ///< of the triangles of a group that simplifying leaves
  float stuck_ratio = 0.85f;          ///< a group that keeps more of them is not simplified
};

/// Clusters that were simplified together. Ball and error hold those of all groups below it, so the
/// pixels of a group are never less than those of the groups that its clusters came from.
struct ClusterGroup {
  Sphere ball;
  float error = 0;  ///< that simplifying it makes, model units; infinite where it is stuck
  std::uint32_t depth = 0;
};

struct Cluster {
  std::uint32_t first_triangle = 0, triangle_count = 0;
  std::uint32_t made_by = kNone;  ///< the group that was simplified to it; kNone: the original
  std::uint32_t group = kNone;    ///< that it is in
};

class ClusterDag {
 public:
  /// Vertices of equal positions must be one vertex. Single-threaded.
  explicit ClusterDag(const TriangleMesh& mesh, const ClusterDagOptions& options = {});

  /// The clusters that are good enough, of groups that are not: each place of the surface once.
  /// O(clusters).
  [[nodiscard]] std::vector<std::uint32_t> cut(const PixelScale& scale, float pixels) const;

  [[nodiscard]] const std::vector<Vec3>& positions() const { return positions_; }
  [[nodiscard]] std::span<const Cluster> clusters() const { return clusters_; }
  [[nodiscard]] std::span<const ClusterGroup> groups() const { return groups_; }
  [[nodiscard]] std::span<const std::uint32_t> indices_of(const Cluster& cluster) const {
    return std::span(indices_).subspan(3 * std::size_t{cluster.first_triangle},
                                       3 * std::size_t{cluster.triangle_count});
  }
  [[nodiscard]] std::uint32_t stored_triangles() const {
    return static_cast<std::uint32_t>(indices_.size() / 3);
  }

 private:
  struct Piece;
  void add_clusters(std::span<const std::uint32_t> indices, std::uint32_t made_by);
  void simplify_group(std::span<const std::uint32_t> members);
  [[nodiscard]] Sphere ball_of(const Cluster& cluster) const;
  [[nodiscard]] float error_of(const Cluster& cluster) const {
    return cluster.made_by == kNone ? 0 : groups_[cluster.made_by].error;
  }

  ClusterDagOptions options_;
  std::vector<Vec3> positions_;
  std::vector<std::uint32_t> indices_;
  std::vector<Cluster> clusters_;
  std::vector<ClusterGroup> groups_;
  std::vector<std::uint32_t> pending_, local_of_;  // while building
};

}  // namespace varifold::bench
