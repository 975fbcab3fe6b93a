// Where new triangles go that no strip crosses: to the end of a strip, or into a strip of their
// own.
#include <varifold/strip/sequence_strips.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace varifold {

void SequenceStrips::place_new_triangles() {
  while (!unplaced_.empty()) {
    Placement best;
    // All of a split's triangles are looked at; those of a base one after the other.
    constexpr std::size_t kMostCandidates = 8;
    std::size_t chosen = unplaced_.size() - 1;
    for (std::size_t i = unplaced_.size() - std::min(unplaced_.size(), kMostCandidates);
         i < unplaced_.size(); ++i) {
      const Placement placement = best_placement(unplaced_[i]);
      if (placement.cost >= best.cost) continue;
      best = placement;
      chosen = i;
    }
    const std::uint32_t triangle = unplaced_[chosen];
    if (best.way == Placement::kNowhere)
      open(triangle);
    else if (!place(triangle, best))
      continue;  // a block was split for room; the ends are others now
    unplaced_.erase(unplaced_.begin() + static_cast<std::ptrdiff_t>(chosen));
  }
}

SequenceStrips::Placement SequenceStrips::best_placement(std::uint32_t triangle) const {
  Placement best;
  for (std::uint32_t e = 0; e < 3; ++e) {
    if (neighbor_[3 * triangle + e] == kNone) continue;
    const Placement placement = placement_at(triangle, e);
    if (placement.cost < best.cost) best = placement;
  }
  return best;
}

// Joining `triangle` to its neighbour across `edge`, where that is the first or last of its strip.
SequenceStrips::Placement SequenceStrips::placement_at(std::uint32_t triangle,
                                                       std::uint32_t edge) const {
  Placement found;
  const Edge other = across({triangle, edge});
  if (other.triangle == kNone || block_of_[other.triangle] == kNone) return found;
  const Block& block = blocks_[block_of_[other.triangle]];
  const std::uint32_t i = place_of(block, other.triangle);
  const std::uint32_t* const slot = block.slots + i;
  const bool is_head = i == 0 || slot[-1] == kStripRestart;
  const bool is_tail = i + 3 == block.count || slot[3] == kStripRestart;
  // The corner of the neighbour that is not on the edge says by which edge it is left.
  const std::uint32_t opposite = corner({other.triangle, other.edge + 2});
  const auto use = [&](Placement::Way way, std::uint32_t cost) {
    if (cost >= found.cost) return;
    found.way = way;
    found.cost = cost;
  };
  if (is_head && is_tail) {
    found.rotation = opposite == slot[0] ? 0 : opposite == slot[1] ? 1 : 2;
    use(found.rotation == 0 ? Placement::kTail : Placement::kRotated, 1);
  } else if (is_tail) {
    if (opposite == slot[0]) use(Placement::kTail, 1);
    if (opposite == slot[1]) use(Placement::kTailTurn, 2);
  } else if (is_head && opposite == slot[2]) {
    use((strip_end(block, i) - i) % 2 == 0 ? Placement::kReversed : Placement::kHeadPair,
        (strip_end(block, i) - i) % 2 == 0 ? 1 : 2);
  } else if (i > 0 && slot[-1] == slot[0] && opposite == slot[2] &&
             (i == 1 || slot[-2] == kStripRestart)) {
    use(Placement::kPad, 0);
  }
  if (found.way == Placement::kNowhere) return found;
  found.block = block_of_[other.triangle];
  found.place = i;
  found.value = corner({triangle, edge + 2});
  return found;
}

// False where the block had to be split first, so that the placement may no longer hold.
bool SequenceStrips::place(std::uint32_t triangle, const Placement& placement) {
  const std::uint32_t b = placement.block;
  if (make_room(b, placement.cost)) return false;
  const auto at = [](std::uint32_t slot) { return static_cast<std::uint8_t>(slot); };
  std::uint32_t i = placement.place;
  switch (placement.way) {
    case Placement::kRotated:
      apply({BlockChange::kRotate, at(i), at(placement.rotation), b});
      learn_first_corner(blocks_[b].triangle[i], blocks_[b].slots[i]);
      break;
    case Placement::kTailTurn: {
      const std::uint32_t last = blocks_[b].triangle[i];
      apply({BlockChange::kInsert, at(i + 2), 0, b, blocks_[b].slots[i]});
      blocks_[b].triangle[i] = kNone;
      blocks_[b].triangle[++i] = last;
      break;
    }
    case Placement::kReversed: {
      const std::uint32_t length = strip_end(blocks_[b], i) - i;
      apply({BlockChange::kReverse, at(i), at(length), b});
      i += length - 3;
      break;
    }
    case Placement::kHeadPair:
      apply({BlockChange::kInsert, at(i), 0, b, placement.value});
      apply({BlockChange::kInsert, at(i), 0, b, placement.value});
      set_triangle(b, i + 1, triangle);
      return true;
    case Placement::kPad:
      apply({BlockChange::kAssign, at(i - 1), 0, b, placement.value});
      set_triangle(b, i - 1, triangle);
      return true;
    default:
      break;
  }
  apply({BlockChange::kInsert, at(i + 3), 0, b, placement.value});
  set_triangle(b, i + 1, triangle);
  return true;
}

void SequenceStrips::learn_first_corner(std::uint32_t triangle, std::uint32_t vertex) {
  for (std::uint8_t c = 0; c < 3; ++c)
    if (corners_[3 * triangle + c] == vertex && learned_[triangle] == kAnyCorner)
      learned_[triangle] = c;
}

// A block with room for a strip of one triangle: one that holds a neighbour, else any.
std::uint32_t SequenceStrips::block_for(std::uint32_t triangle) {
  constexpr std::uint32_t kSlots = 4;
  std::uint32_t best = kNone;
  for (std::uint32_t e = 0; e < 3; ++e) {
    const std::uint32_t other = neighbor_[3 * triangle + e];
    if (other == kNone || block_of_[other] == kNone) continue;
    const std::uint32_t b = block_of_[other];
    if (best == kNone || blocks_[b].count < blocks_[best].count) best = b;
  }
  std::uint32_t& last = last_block_[range_of(triangle)];
  if (best == kNone) best = last;
  if (best == kNone) {
    apply({BlockChange::kNewBlock, 0, 0, block_count(), range_of(triangle)});
    best = block_count() - 1;
  }
  make_room(best, kSlots);
  last = best;
  return best;
}

void SequenceStrips::open(std::uint32_t triangle) {
  const std::uint32_t b = block_for(triangle);
  const auto end = static_cast<std::uint8_t>(blocks_[b].count);
  const std::uint32_t* const corners = corners_of(triangle);
  const std::uint32_t first = first_[triangle] == kAnyCorner ? 0 : first_[triangle];
  const std::array<std::uint32_t, 3> slots{corners[first], corners[(first + 1) % 3],
                                           corners[(first + 2) % 3]};
  for (std::uint32_t place = 0; place < 3; ++place) {
    // The other two: a new vertex and its target, in one order or the other.
    const std::uint32_t a = slots[place == 0 ? 1 : 0], c = slots[place == 2 ? 1 : 2];
    for (const bool target_first : {false, true}) {
      const std::uint32_t vertex = target_first ? c : a;
      if (vertex < sequence_.vertices[level_] || sequence_.target[vertex] != (target_first ? a : c))
        continue;
      apply({BlockChange::kOpen, end, static_cast<std::uint8_t>(2 * place + (target_first ? 1 : 0)),
             b, slots[place], vertex});
      set_triangle(b, blocks_[b].count - 3, triangle);
      return;
    }
  }
  if (end > 0) apply({BlockChange::kInsert, end, 0, b, kStripRestart});
  for (std::uint32_t c = 0; c < 3; ++c)
    apply({BlockChange::kInsert, static_cast<std::uint8_t>(blocks_[b].count), 0, b, slots[c]});
  set_triangle(b, blocks_[b].count - 3, triangle);
}

}  // namespace varifold
