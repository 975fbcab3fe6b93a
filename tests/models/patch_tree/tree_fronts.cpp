#include <tests/models/patch_tree/tree_fronts.h>
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

WholeSurface::WholeSurface(const PatchTree& tree)
    : mesh_(extract_front(tree, uniform_front(tree.topology(), tree.topology().level_count() - 1))),
      weld_(weld_exact(mesh_.positions)),
      topology_(analyze_topology(mesh_, weld_, 1)),
      components_(weld_.class_count) {
  for (std::size_t i = 0; i < mesh_.indices.size(); i += 3)
    for (std::size_t k = 1; k < 3; ++k)
      components_.unite(weld_.class_of[mesh_.indices[i]], weld_.class_of[mesh_.indices[i + k]]);
}

TopologyReport WholeSurface::topology_of_parts_in(const TriangleMesh& front) const {
  // Both in one list of positions: equal ones are of one class.
  std::vector<Vec3> positions = mesh_.positions;
  positions.insert(positions.end(), front.positions.begin(), front.positions.end());
  const WeldMap both = weld_exact(positions);
  std::vector<bool> is_shown(both.class_count, false), has_component(weld_.class_count, false);
  for (const std::uint32_t v : front.indices)
    is_shown[both.class_of[mesh_.vertex_count() + v]] = true;
  DisjointSets components = components_;
  for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v)
    if (is_shown[both.class_of[v]]) has_component[components.find(weld_.class_of[v])] = true;
  TriangleMesh parts;
  parts.positions = mesh_.positions;
  for (std::size_t i = 0; i < mesh_.indices.size(); i += 3)
    if (has_component[components.find(weld_.class_of[mesh_.indices[i]])])
      parts.indices.insert(parts.indices.end(), &mesh_.indices[i], &mesh_.indices[i] + 3);
  return analyze_topology(parts, weld_, 1);
}

std::string fault_of_front(const PatchTree& tree, const SplitNodes& is_split,
                           const WholeSurface& whole) {
  if (!is_legal(tree.topology(), is_split)) return "not legal";
  const TriangleMesh front = extract_front(tree, is_split);
  const TopologyReport found = analyze_topology(front, weld_exact(front.positions), 1);
  const TopologyReport expected = found.components == whole.topology().components
                                      ? whole.topology()
                                      : whole.topology_of_parts_in(front);
  if (found.boundary_edges > expected.boundary_edges) return "open edges";
  if (found.nonmanifold_edges > expected.nonmanifold_edges) return "non-manifold edges";
  if (found.misoriented_edges > expected.misoriented_edges) return "misoriented edges";
  if (found.duplicate_triangles > expected.duplicate_triangles) return "doubled triangles";
  if (found.euler_characteristic != expected.euler_characteristic) return "Euler characteristic";
  if (found.components != expected.components) return "components";
  if (found.closed != expected.closed) return "no longer closed";
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
