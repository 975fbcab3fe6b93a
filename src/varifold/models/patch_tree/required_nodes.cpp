#include <varifold/models/patch_tree/required_nodes.h>

#include <algorithm>

namespace varifold {

RequiredNodes::RequiredNodes(const PatchTopology& topology) {
  const std::uint32_t inner = inner_node_count(topology);
  first_.reserve(inner + 1);
  first_.push_back(0);
  for (std::uint32_t node = 0; node < inner; ++node) {
    const auto begin = static_cast<std::ptrdiff_t>(nodes_.size());
    const auto require = [&](std::uint32_t parent) {
      if (parent != kNone &&
          std::find(nodes_.begin() + begin, nodes_.end(), parent) == nodes_.end())
        nodes_.push_back(parent);
    };
    require(topology.parent[node]);
    for (const std::uint32_t neighbor : topology.neighbors_of(node))
      require(topology.parent[neighbor]);
    first_.push_back(static_cast<std::uint32_t>(nodes_.size()));
  }
}

}  // namespace varifold
