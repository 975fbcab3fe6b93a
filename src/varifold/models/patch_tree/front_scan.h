// Nodes whose priorities lie within bounds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace varifold::front_scan {

struct Window {
  float above, up_to;  ///< above < priority <= up_to
};

/// Sets of nodes whose words are empty but for `words`, a set of words.
struct Among {
  std::span<const std::uint64_t> words, nodes;
  std::span<const float> priorities;
};

/// Which are above the tolerance, into the words of `above`.
void find_above(const Among& among, float tolerance, std::span<std::uint64_t> above);
/// Adds those within the window that are not in `except`, ascending; nothing is where that has no
/// words.
void collect(const Among& among, std::span<const std::uint64_t> except, const Window& window,
             std::vector<std::uint32_t>& found);

/// Of a word of a set, whose priorities are given from that of its bit 0 on. In two ways with the
/// same results: with the vectors that the machine has, and without.
[[nodiscard]] std::uint64_t word_within(std::uint64_t nodes, const float* priorities,
                                        const Window& window);
[[nodiscard]] std::uint64_t word_within_plain(std::uint64_t nodes, const float* priorities,
                                              const Window& window);

}  // namespace varifold::front_scan
