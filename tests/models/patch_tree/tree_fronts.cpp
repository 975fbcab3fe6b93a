#include <tests/models/patch_tree/tree_fronts.h>
#include <varifold/mesh/weld.h>
#include <varifold/models/patch_tree/extract.h>
#include <array>

namespace varifold::test {

namespace {

// By the definition: first the parent, then the parents of all neighbours.
void split_with_required(const PatchTopology& topology, std::uint32_t node, SplitNodes& is_split) {
  if (node == kNone || is_split[node] || topology.is_leaf(node)) return;
  const std::uint32_t parent = topology.parent[node];
  if (parent != kNone) {
    split_with_required(topology, parent, is_split);
    for (const std::uint32_t neighbor : topology.neighbors_of(node))
      split_with_required(topology, topology.parent[neighbor], is_split);
  }
  is_split[node] = 1;
}

}  // namespace

SplitNodes random_front(const PatchTopology& topology, Random& random) {
  SplitNodes is_split(topology.node_count(), 0);
  const std::uint32_t leaves = topology.first_of_level[topology.level_count() - 1];
  const auto split_above = [&](std::uint32_t node) {
    split_with_required(topology, topology.parent[node], is_split);
  };
  switch (random.below(3)) {
    case 0:
      split_above(leaves + random.below(topology.node_count() - leaves));
      break;
    case 1:
      for (std::uint32_t i = random.below(9); i > 0; --i)
        split_above(random.below(topology.node_count()));
      break;
    default: {
      const double part = random.uniform();
      for (std::uint32_t node = 0; node < topology.node_count(); ++node) {
        const std::uint32_t parent = topology.parent[node];
        const bool exists = parent == kNone || is_split[parent];
        if (exists && random.uniform() < part) split_with_required(topology, node, is_split);
      }
    }
  }
  return is_split;
}

SplitNodes uniform_front(const PatchTopology& topology, std::uint32_t level) {
  SplitNodes is_split(topology.node_count(), 0);
  for (std::uint32_t node = 0; node < topology.first_of_level[level]; ++node) is_split[node] = 1;
  return is_split;
}

std::string fault_of_front(const PatchTree& tree, const SplitNodes& is_split,
                           const TopologyReport& mesh) {
  if (!is_legal(tree.topology(), is_split)) return "not legal";
  const TriangleMesh front = extract_front(tree, is_split);
  const TopologyReport found = analyze_topology(front, weld_exact(front.positions), 1);
  if (found.boundary_edges > mesh.boundary_edges) return "open edges";
  if (found.nonmanifold_edges > mesh.nonmanifold_edges) return "non-manifold edges";
  if (found.misoriented_edges > mesh.misoriented_edges) return "misoriented edges";
  if (found.duplicate_triangles > mesh.duplicate_triangles) return "doubled triangles";
  if (found.euler_characteristic != mesh.euler_characteristic) return "Euler characteristic";
  if (found.components != mesh.components) return "components";
  if (found.closed != mesh.closed) return "no longer closed";
  return {};
}

std::uint32_t turned_triangles(const PatchTreeData& tree, const SplitNodes& is_split) {
  std::uint32_t turned = 0;
  for (std::uint32_t node = 0; node < tree.topology.node_count(); ++node) {
    const std::uint32_t parent = tree.topology.parent[node];
    if (!is_in_front(tree.topology, is_split, node) || parent == kNone) continue;
    const std::uint32_t mask = coarse_neighbors(tree.topology, is_split, parent);
    for (std::size_t t = tree.offsets[node].triangle; t < tree.offsets[node + 1].triangle; ++t) {
      std::array<DVec3, 3> before, after;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = tree.offsets[node].vertex + tree.corners[3 * t + k];
        before[k] = tree.vertices.positions[v];
        after[k] = tree.vertices.positions[drawn_vertex(tree, node, v, mask)];
      }
      const auto normal = [](const std::array<DVec3, 3>& p) {
        return glm::cross(p[1] - p[0], p[2] - p[0]);
      };
      const DVec3 a = normal(before), b = normal(after);
      const bool collapsed = after[0] == after[1] || after[1] == after[2] || after[2] == after[0];
      if (collapsed || a == DVec3(0)) continue;
      if (!(glm::dot(a, b) > 0.2587 * glm::length(a) * glm::length(b))) ++turned;
    }
  }
  return turned;
}

}  // namespace varifold::test
