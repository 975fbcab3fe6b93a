// Strips as paths from triangle to triangle, before they become indices.
#pragma once

#include <varifold/strip/adjacency.h>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

namespace varifold {

/// Which way a strip turns in a triangle: it leaves by the edge after (0) or before (1) the one by
/// which it came. Turns that alternate cost nothing; two equal ones in a row cost a swap.
[[nodiscard]] inline std::uint32_t turn(std::uint32_t entry, std::uint32_t exit) {
  return exit == next_half_edge(entry) ? 0 : 1;
}
[[nodiscard]] inline std::uint32_t exit_of(std::uint32_t entry, std::uint32_t turn) {
  return turn == 0 ? next_half_edge(entry) : previous_half_edge(entry);
}

/// A turn that there is not: at the first and the last triangle of a strip.
inline constexpr std::uint32_t kNoTurn = 2;

/// What two turns in a row cost: 1 where they are equal.
[[nodiscard]] inline int swap_cost(std::uint32_t turn, std::uint32_t next_turn) {
  return turn == next_turn && turn != kNoTurn ? 1 : 0;
}

/// Indices that a strip costs beside one a triangle: two at its beginning, and the restart.
inline constexpr int kStripCost = 3;

/// A set of edges that strips cross: every triangle has at most two of them, and there is no
/// cycle, so that what hangs together is a path. The class keeps the edges; that they are paths is
/// up to who links.
class StripPaths {
 public:
  explicit StripPaths(std::vector<std::uint32_t> across)
      : across_(std::move(across)), links_(across_.size() / 3, 0) {}

  [[nodiscard]] std::uint32_t triangle_count() const {
    return static_cast<std::uint32_t>(links_.size());
  }
  /// See edge_adjacency().
  [[nodiscard]] std::uint32_t across(std::uint32_t half_edge) const { return across_[half_edge]; }

  [[nodiscard]] bool linked(std::uint32_t half_edge) const {
    return (links_[half_edge / 3] >> (half_edge % 3) & 1u) != 0;
  }
  [[nodiscard]] std::uint32_t degree(std::uint32_t triangle) const {
    return static_cast<std::uint32_t>(std::popcount(links_[triangle]));
  }
  /// A linked half-edge of a triangle that has one.
  [[nodiscard]] std::uint32_t some_link(std::uint32_t triangle) const {
    return 3 * triangle + static_cast<std::uint32_t>(std::countr_zero(links_[triangle]));
  }
  /// The other linked half-edge of a triangle, or kNone.
  [[nodiscard]] std::uint32_t other_link(std::uint32_t half_edge) const {
    const std::uint32_t next = next_half_edge(half_edge), previous = previous_half_edge(half_edge);
    return linked(next) ? next : linked(previous) ? previous : kNone;
  }

  void link(std::uint32_t half_edge) { flip(half_edge); }
  void unlink(std::uint32_t half_edge) { flip(half_edge); }

 private:
  void flip(std::uint32_t half_edge) {
    const std::uint32_t other = across_[half_edge];
    links_[half_edge / 3] ^= static_cast<std::uint8_t>(1u << (half_edge % 3));
    links_[other / 3] ^= static_cast<std::uint8_t>(1u << (other % 3));
  }

  std::vector<std::uint32_t> across_;
  std::vector<std::uint8_t> links_;  // per triangle, a bit per edge
};

}  // namespace varifold
