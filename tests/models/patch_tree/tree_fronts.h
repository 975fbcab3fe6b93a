// Legal fronts of patch trees, made at random, and what must hold of each.
#pragma once

#include <varifold/base/disjoint_sets.h>
#include <varifold/base/random.h>
#include <varifold/mesh/topology.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/mesh/weld.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <cstdint>
#include <string>
#include <vector>

namespace varifold::test {

using SplitNodes = std::vector<std::uint8_t>;  // a byte per node

/// A legal front: by turns of one leaf, of a few nodes, and of very many.
[[nodiscard]] SplitNodes random_front(const PatchTopology& topology, Random& random);

/// All nodes of a level.
[[nodiscard]] SplitNodes uniform_front(const PatchTopology& topology, std::uint32_t level);

/// The full mesh that fronts are compared with.
class WholeSurface {
 public:
  explicit WholeSurface(const PatchTree& tree);
  [[nodiscard]] const TopologyReport& topology() const { return topology_; }
  /// The topology of those components that `front` has vertices of; others have vanished.
  [[nodiscard]] TopologyReport topology_of_parts_in(const TriangleMesh& front) const;

 private:
  TriangleMesh mesh_;
  WeldMap weld_;
  TopologyReport topology_;
  DisjointSets components_;  // of position classes
};

/// Empty where the front is as sound as the mesh; else what is wrong.
[[nodiscard]] std::string fault_of_front(const PatchTree& tree, const SplitNodes& is_split,
                                         const WholeSurface& whole);

/// How many triangles the switches of a front turn by more than 75 degrees.
[[nodiscard]] std::uint32_t turned_triangles(const PatchTreeData& tree, const SplitNodes& is_split);

}  // namespace varifold::test
