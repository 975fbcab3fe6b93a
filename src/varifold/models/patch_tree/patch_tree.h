// The patch tree: every node is a patch of surface, its children the same surface in more detail.
//
// Based on: [Birkholz2007] section 3.
// Differs: borders are switched by the survivors of collapses and not by the nearest vertex, so
//   that all patches at a border agree (docs/algorithms/patch_tree.md); several roots where the
//   surface has no single coarse patch.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/cone.h>
#include <varifold/view/sphere.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// What choosing a front needs to know of a node.
struct PatchBounds {
  Sphere ball;  ///< holds the patch and all that stands below it; so it holds those of the children
  /// How far the patch is off the original, model units: not less than the distance of any vertex
  /// of the original that the patch stands for, nor than the error of any child; 0 for leaves.
  float error = 0;
  /// The paper's priority: the mean squared distance between the vertices of the children and the
  /// patch; not less than that of any child; 0 for leaves.
  float mean_squared = 0;
  NormalCone cone;  ///< of the normals of the patch and of all that stands below it
};

/// The triangles of one material in a patch. Those that no switch of a border changes come first.
struct PatchRange {
  std::uint32_t material = 0;  ///< index into TriangleMesh::materials
  std::uint32_t constant_triangles = 0;
  std::uint32_t triangle_count = 0;
};

/// Where the parts of a node begin in the arrays of the tree; they end where those of the next node
/// begin.
struct PatchOffsets {
  std::uint32_t vertex = 0, triangle = 0, controller = 0, range = 0;
};

/// Nodes are numbered level by level from the roots on, the children of a node one after the other
/// and in the order of their parents. Level 0 are the roots; all leaves stand in the finest level.
struct PatchTopology {
  std::vector<std::uint32_t> first_of_level;  ///< per level, and one more
  std::vector<std::uint32_t> parent;          ///< kNone for roots
  /// Per node, and one more: its children are [first_child[n], first_child[n + 1]).
  std::vector<std::uint32_t> first_child;
  /// The nodes of the same level that share a vertex with the node, those that control vertices of
  /// its children first: neighbors[first_neighbor[n]] and on.
  std::vector<std::uint32_t> first_neighbor;  ///< per node, and one more
  std::vector<std::uint32_t> neighbors;

  [[nodiscard]] std::uint32_t node_count() const {
    return static_cast<std::uint32_t>(parent.size());
  }
  [[nodiscard]] std::uint32_t level_count() const {
    return first_of_level.empty() ? 0 : static_cast<std::uint32_t>(first_of_level.size() - 1);
  }
  [[nodiscard]] bool is_leaf(std::uint32_t node) const {
    return first_child[node] == first_child[node + 1];
  }
  [[nodiscard]] std::span<const std::uint32_t> neighbors_of(std::uint32_t node) const {
    return {neighbors.data() + first_neighbor[node], neighbors.data() + first_neighbor[node + 1]};
  }
};

/// How many neighbours of a node may control vertices of its children: a bit each.
inline constexpr std::uint32_t kMaxControllers = 32;

/// The parts of the model, plain data.
///
/// A front is a set of nodes that covers the surface once, where nodes that share a vertex differ
/// by at most one level. Where a node stands beside one that is a level coarser, its vertices on
/// their common border move onto their survivors: vertex v of node n, controlled by bit b, is drawn
/// as vertex survivor[v] of the parent of n where neighbour b of the parent is not split. So the
/// triangles of a patch are constant, and what varies is where a few vertices fetch their
/// attributes from. Triangles that collapse by that are drawn without area.
struct PatchTreeData {
  PatchTopology topology;
  std::vector<PatchBounds> bounds;    ///< per node
  std::vector<PatchOffsets> offsets;  ///< per node, and one more
  /// Attributes of the vertices, patch by patch, the ones that can move first in each; materials
  /// and images; neither indices nor ranges.
  TriangleMesh vertices;
  /// Per vertex: the vertex of the parent's patch, counted in that, that stands for it there; its
  /// own number in roots.
  std::vector<std::uint16_t> survivors;
  /// Per vertex that can move: the bit of the neighbour of the parent that moves it.
  std::vector<std::uint8_t> controllers;
  std::vector<std::uint16_t> corners;  ///< three per triangle, counted in the patch
  std::vector<PatchRange> ranges;
};

/// Immutable, shared by any number of instances and threads; satisfies LeveledModel. Level k is the
/// front of all nodes of level k of the tree.
class PatchTree {
 public:
  PatchTree() = default;
  /// Everything must be consistent, as from build_patch_tree(). O(nodes).
  explicit PatchTree(PatchTreeData data);

  [[nodiscard]] const PatchTreeData& data() const { return data_; }
  [[nodiscard]] const PatchTopology& topology() const { return data_.topology; }
  [[nodiscard]] std::uint32_t node_count() const { return data_.topology.node_count(); }
  [[nodiscard]] std::uint32_t triangle_count_of(std::uint32_t node) const {
    return data_.offsets[node + 1].triangle - data_.offsets[node].triangle;
  }
  [[nodiscard]] std::uint32_t vertex_count_of(std::uint32_t node) const {
    return data_.offsets[node + 1].vertex - data_.offsets[node].vertex;
  }

  [[nodiscard]] std::uint32_t finest_level() const {
    return data_.topology.level_count() == 0 ? 0 : data_.topology.level_count() - 1;
  }
  /// The level that a node stands in. O(log levels).
  [[nodiscard]] std::uint32_t level_of(std::uint32_t node) const;
  /// Of all patches of the level together: vertices that patches share count for each, and
  /// vertices that only children need count, too.
  [[nodiscard]] std::uint32_t vertex_count(std::uint32_t level) const;
  [[nodiscard]] std::uint32_t triangle_count(std::uint32_t level) const;
  /// How far vertices of the full mesh are off the level at most, model units; not greater than
  /// that of the coarser level.
  [[nodiscard]] float error(std::uint32_t level) const {
    return level < level_errors_.size() ? level_errors_[level] : 0;
  }
  [[nodiscard]] static bool error_is_measured() { return true; }
  /// The finest level with at most so many triangles or vertices; 0 where even that has more.
  [[nodiscard]] std::uint32_t level_for_triangles(std::uint32_t count) const;
  [[nodiscard]] std::uint32_t level_for_vertices(std::uint32_t count) const;
  /// The coarsest level whose error is at most `bound`.
  [[nodiscard]] std::uint32_t level_for_error(float bound) const;
  /// The finest level with at most this part of the vertices that level 0 lacks; 1 is the finest.
  [[nodiscard]] std::uint32_t level_for_fraction(float fraction) const;

  /// The vertices of all patches, with materials and images; neither indices nor ranges.
  [[nodiscard]] const TriangleMesh& attributes() const { return data_.vertices; }
  /// Memory of all arrays but images.
  [[nodiscard]] std::size_t bytes() const;

 private:
  PatchTreeData data_;
  std::vector<float> level_errors_;
};

}  // namespace varifold
