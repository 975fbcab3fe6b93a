// The vertices of a sequence in an order in which those near in space are near.
#pragma once

#include <varifold/simplify/collapse_sequence.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// Per vertex, its place in the tree of targets: each before those that go to it, and of these in
/// the order in which they come, with all that came to them before. O(vertices).
[[nodiscard]] std::vector<std::uint32_t> places_in_tree(const CollapseSequence& sequence);

}  // namespace varifold
