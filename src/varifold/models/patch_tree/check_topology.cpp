#include <varifold/models/patch_tree/check_topology.h>

#include <algorithm>
#include <vector>

namespace varifold {

const char* check_neighbors(const PatchTopology& topology) {
  // The nodes that name a node as their neighbour, ascending, at the places of its own neighbours.
  std::vector<std::uint32_t> next(topology.first_neighbor.begin(),
                                  topology.first_neighbor.end() - 1);
  std::vector<std::uint32_t> named_by(topology.neighbors.size(), kNone);
  for (std::uint32_t node = 0; node < topology.node_count(); ++node) {
    for (const std::uint32_t neighbor : topology.neighbors_of(node)) {
      if (neighbor == node) return "a patch is its own neighbour";
      if (next[neighbor] == topology.first_neighbor[neighbor + 1])
        return "a neighbour does not know of it";
      named_by[next[neighbor]++] = node;
    }
  }
  std::vector<std::uint32_t> sorted(topology.neighbors);
  for (std::uint32_t node = 0; node < topology.node_count(); ++node) {
    const auto begin = sorted.begin() + topology.first_neighbor[node];
    const auto end = sorted.begin() + topology.first_neighbor[node + 1];
    std::sort(begin, end);
    if (std::adjacent_find(begin, end) != end) return "a patch has a neighbour twice";
  }
  return sorted == named_by ? nullptr : "a neighbour does not know of it";
}

const char* check_bounds(const PatchTopology& topology, std::span<const PatchBounds> bounds) {
  constexpr double kRounding = 1 + 1e-5;
  for (std::uint32_t node = 0; node < topology.node_count(); ++node) {
    const PatchBounds& outer = bounds[node];
    for (std::uint32_t child = topology.first_child[node]; child < topology.first_child[node + 1];
         ++child) {
      const PatchBounds& inner = bounds[child];
      const double apart = glm::length(DVec3(inner.ball.center) - DVec3(outer.ball.center));
      if (apart + inner.ball.radius > outer.ball.radius * kRounding + 1e-30)
        return "a ball does not hold those of the children";
      if (inner.error > outer.error || inner.mean_squared > outer.mean_squared)
        return "an error is less than those of the children";
    }
  }
  return nullptr;
}

}  // namespace varifold
