// Groups of neighbouring clusters, for the cluster DAG that patch trees are compared with.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace varifold::bench {

/// Groups clusters that share vertices: the smallest group first, with the neighbour that it shares
/// the most vertices with for its size, until groups have `wanted` clusters; none has more than
/// `wanted` + `wanted` / 3. `clusters` are the vertices of each, ascending and without repeats.
/// Every cluster is in one group. The result depends on the arguments alone. O(n log n).
[[nodiscard]] std::vector<std::vector<std::uint32_t>> group_clusters(
    std::span<const std::vector<std::uint32_t>> clusters, std::uint32_t wanted);

}  // namespace varifold::bench
