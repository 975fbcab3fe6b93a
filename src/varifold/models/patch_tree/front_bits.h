// Sets of nodes as bits in words of 64, and sets of words in turn, so that what is empty is
// skipped.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace varifold::front_bits {

[[nodiscard]] inline bool has(std::span<const std::uint64_t> set, std::uint32_t i) {
  return (set[i / 64] >> i % 64 & 1u) != 0;
}
inline void add(std::span<std::uint64_t> set, std::uint32_t i) { set[i / 64] |= 1ull << i % 64; }
inline void remove(std::span<std::uint64_t> set, std::uint32_t i) {
  set[i / 64] &= ~(1ull << i % 64);
}

/// Calls visit(i) for the members that a word has, ascending.
template <class Visit>
void for_each_of_word(std::uint64_t bits, std::uint32_t word, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1)
    visit(64 * word + static_cast<std::uint32_t>(std::countr_zero(bits)));
}
template <class Visit>
void for_each_of_word_down(std::uint64_t bits, std::uint32_t word, const Visit& visit) {
  while (bits != 0) {
    const auto bit = 63u - static_cast<std::uint32_t>(std::countl_zero(bits));
    bits &= ~(1ull << bit);
    visit(64 * word + bit);
  }
}
/// Calls visit(i) for all members, ascending.
template <class Visit>
void for_each(std::span<const std::uint64_t> set, const Visit& visit) {
  for (std::uint32_t word = 0; word < set.size(); ++word) for_each_of_word(set[word], word, visit);
}
template <class Visit>
void for_each_down(std::span<const std::uint64_t> set, const Visit& visit) {
  for (auto word = static_cast<std::uint32_t>(set.size()); word-- > 0;)
    for_each_of_word_down(set[word], word, visit);
}

/// Calls visit(word, mask) for the words of [first, end).
template <class Visit>
void for_each_part(std::uint32_t first, std::uint32_t end, const Visit& visit) {
  while (first < end) {
    const std::uint32_t count = std::min(64 - first % 64, end - first);
    visit(first / 64, ~0ull >> (64 - count) << first % 64);
    first += count;
  }
}

}  // namespace varifold::front_bits
