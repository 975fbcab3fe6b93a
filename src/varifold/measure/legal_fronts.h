// Private to this folder: fronts of patch trees that no view would ask for.
#pragma once

#include <varifold/models/patch_tree/patch_tree.h>
#include <cstdint>
#include <vector>

namespace varifold::check {

struct LegalFront {
  const char* name = "";
  std::vector<std::uint8_t> is_split;  ///< per node
};

/// By turns: nodes at random; one deepest leaf; chains of neighbours from leaf to leaf; a leaf in
/// each of a few places; all of a level but a few nodes. Each with all that it needs to be legal,
/// and depending on the number and the tree alone. O(nodes).
[[nodiscard]] LegalFront legal_front(const PatchTopology& topology, std::uint32_t number);

}  // namespace varifold::check
