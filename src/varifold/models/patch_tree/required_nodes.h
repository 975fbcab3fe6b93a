// Which nodes must be split before a node may be.
//
// Based on: [Birkholz2007] section 4 (a patch is split only when its neighbours are of its level).
// Differs: neighbours share a vertex, not only an edge, so that the borders of a front fit; the
//   list is made once instead of looking for marks.
#pragma once

#include <varifold/models/patch_tree/patch_tree.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Nodes that have children: those before this one.
[[nodiscard]] inline std::uint32_t inner_node_count(const PatchTopology& topology) {
  const std::uint32_t levels = topology.level_count();
  return levels == 0 ? 0 : topology.first_of_level[levels - 1];
}

/// Of every inner node, the nodes that it requires: its parent and those of its neighbours, each
/// once, the own one first. They all are of the next coarser level, so their numbers are smaller.
/// A set of nodes that has with every node those that it requires is closed. Where just these are
/// split, patches of the front that share a vertex differ by at most one level: say that the finer
/// one is two levels or more below the other, a. Its ancestor on the level of a's children is
/// split, and touches one of these, so it requires a. But a is not split.
class RequiredNodes {
 public:
  RequiredNodes() = default;
  /// O(neighbours squared) a node.
  explicit RequiredNodes(const PatchTopology& topology);

  /// None for roots.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t node) const {
    return {nodes_.data() + first_[node], nodes_.data() + first_[node + 1]};
  }
  [[nodiscard]] std::size_t bytes() const {
    return (first_.size() + nodes_.size()) * sizeof(std::uint32_t);
  }

 private:
  std::vector<std::uint32_t> first_, nodes_;
};

}  // namespace varifold
