// A front of a patch tree as a mesh of its own.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <cstdint>
#include <span>

namespace varifold {

/// Whether a node is split, one byte per node. A front is legal when the parent of a split node is
/// split, and so are the parents of its neighbours.
using SplitFlags = std::span<const std::uint8_t>;

[[nodiscard]] bool is_legal(const PatchTopology& topology, SplitFlags is_split);

/// Whether a node is drawn.
[[nodiscard]] inline bool is_in_front(const PatchTopology& topology, SplitFlags is_split,
                                      std::uint32_t node) {
  const std::uint32_t parent = topology.parent[node];
  return !is_split[node] && (parent == kNone || is_split[parent]);
}

/// Bit i is set when neighbour i of a node is not split: with that its children are drawn.
[[nodiscard]] std::uint32_t coarse_neighbors(const PatchTopology& topology, SplitFlags is_split,
                                             std::uint32_t node);

/// The vertex of the tree that is drawn for vertex `v` of `node` (counted in all vertices), when
/// its parent has that mask. O(1).
[[nodiscard]] inline std::uint32_t drawn_vertex(const PatchTreeData& tree, std::uint32_t node,
                                                std::uint32_t v, std::uint32_t mask) {
  const PatchOffsets& at = tree.offsets[node];
  const std::uint32_t local = v - at.vertex;
  if (local >= tree.offsets[node + 1].controller - at.controller) return v;
  if ((mask >> tree.controllers[at.controller + local] & 1) == 0) return v;
  return tree.offsets[tree.topology.parent[node]].vertex + tree.survivors[v];
}

/// Whether two of the corners that are drawn stand at one point.
[[nodiscard]] inline bool is_collapsed(const PatchTreeData& tree, const std::uint32_t (&drawn)[3]) {
  const std::vector<Vec3>& at = tree.vertices.positions;
  return at[drawn[0]] == at[drawn[1]] || at[drawn[1]] == at[drawn[2]] ||
         at[drawn[2]] == at[drawn[0]];
}

/// How many triangles of `node` are collapsed when its parent has that mask. O(border triangles).
[[nodiscard]] std::uint32_t collapsed_triangles(const PatchTreeData& tree, std::uint32_t node,
                                                std::uint32_t mask);

/// The triangles of a front with vertices of equal attributes merged, materials in order. Triangles
/// that the switches collapse are left out. With `switches` false no border is switched, which
/// leaves cracks. O(size of the front).
[[nodiscard]] TriangleMesh extract_front(const PatchTree& tree, SplitFlags is_split,
                                         bool switches = true);

}  // namespace varifold
