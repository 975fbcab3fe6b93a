// Private to this folder: whether topology and bounds that were read are those of a tree.
#pragma once

#include <varifold/models/patch_tree/patch_tree.h>
#include <span>

namespace varifold {

/// Neighbours are other nodes, each once, and the relation is symmetric. They must be of the level
/// of the node. Null, or what is wrong. O(neighbours log neighbours).
[[nodiscard]] const char* check_neighbors(const PatchTopology& topology);

/// Balls hold those of the children, up to rounding; errors are not less than those of the
/// children. Null, or what is wrong.
[[nodiscard]] const char* check_bounds(const PatchTopology& topology,
                                       std::span<const PatchBounds> bounds);

}  // namespace varifold
