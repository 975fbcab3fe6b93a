// Strips as they are to be drawn: without the slivers at the ends of seams (strip_levels.h).
#pragma once

#include <varifold/base/math.h>
#include <cstdint>
#include <span>

namespace varifold {

/// Whether the three indices at `slot` are different vertices at two points.
[[nodiscard]] inline bool is_sliver(std::span<const std::uint32_t> slots, std::uint32_t slot,
                                    std::span<const Vec3> positions) {
  const std::uint32_t a = slots[slot], b = slots[slot + 1], c = slots[slot + 2];
  if (a == b || b == c || c == a) return false;
  return positions[a] == positions[b] || positions[b] == positions[c] ||
         positions[c] == positions[a];
}

/// A piece of a strip. Where it begins at an odd place, its first index stands there twice, so that
/// its triangles keep their orientation.
struct StripPiece {
  std::uint32_t begin = 0, end = 0;  ///< slots
  bool is_odd = false;
};

/// Calls visit(piece) for the parts of a strip between its slivers, and for all of it where it has
/// none. `slivers` are those that the strip has at any level. O(slivers).
template <class Visit>
void for_each_piece(std::span<const std::uint32_t> slots, std::uint32_t first_slot,
                    std::uint32_t end_slot, std::span<const std::uint32_t> slivers,
                    std::span<const Vec3> positions, const Visit& visit) {
  std::uint32_t begin = first_slot;
  for (const std::uint32_t slot : slivers) {
    if (!is_sliver(slots, slot, positions)) continue;
    visit(StripPiece{begin, slot + 2, (begin - first_slot) % 2 == 1});
    begin = slot + 1;
  }
  visit(StripPiece{begin, end_slot, (begin - first_slot) % 2 == 1});
}

/// Indices that a sliver may add to its strip: one that both pieces have, one that turns the second
/// one, and a restart.
inline constexpr std::uint32_t kIndicesPerSliver = 3;

}  // namespace varifold
