// What a split does to the blocks whose triangles get the new vertex.
#include <varifold/strip/sequence_strips.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace varifold {

namespace {

bool same_triangle(const std::array<std::uint32_t, 3>& a, const std::uint32_t* b) {
  for (int turn = 0; turn < 3; ++turn)
    if (a[0] == b[turn] && a[1] == b[(turn + 1) % 3] && a[2] == b[(turn + 2) % 3]) return true;
  return false;
}

}  // namespace

// Changes that are asked for per triangle become changes of slots. A slot that two triangles use
// may get only one vertex: where they ask for different ones, the strip crosses the edge that
// opens, and the slots of that edge are repeated, which makes room for the new triangle in between;
// or the strip is cut there.
void SequenceStrips::change_block(std::uint32_t b, std::span<const Corner> corners) {
  // Splitting a block for room moves some of its triangles to the next new block.
  pieces_.assign(1, b);
  const auto add_piece = [&] { pieces_.push_back(block_count() - 1); };
  for (std::size_t piece = 0; piece < pieces_.size();) {
    const std::uint32_t p = pieces_[piece];
    std::array<std::uint32_t, kMaxSlots> wanted;
    std::fill_n(wanted.begin(), blocks_[p].count, kNone);
    for (const Corner& corner : corners)
      if (block_of_[corner.triangle] == p)
        wanted[place_of(blocks_[p], corner.triangle)] = corner.vertex;
    const Conflict conflict = find_conflict(blocks_[p], wanted.data());
    if (conflict.place == kNone) {
      set_slots(p, wanted.data());
      const std::uint32_t wrong = claim_new_triangles(p);
      if (wrong == kNone)
        ++piece;
      else if (make_room(p, 4))
        add_piece();
      else
        break_run(p, wrong);
    } else if (make_room(p, conflict.has_face ? 2 : 4)) {
      add_piece();
    } else if (conflict.has_face) {
      apply({BlockChange::kDuplicate, static_cast<std::uint8_t>(conflict.place), 0, p});
    } else {
      cut_strip(p, conflict.place);
    }
  }
}

// The first two triangles in a row that ask for different vertices in one slot.
SequenceStrips::Conflict SequenceStrips::find_conflict(const Block& block,
                                                       const std::uint32_t* wanted) const {
  const auto value = [&](std::uint32_t place, std::uint32_t slot) {
    const std::uint32_t v = wanted[place];
    return v != kNone && sequence_.target[v] == block.slots[slot] ? v : block.slots[slot];
  };
  std::uint32_t before = kNone;
  for (std::uint32_t i = 0; i + 2 < block.count; ++i) {
    if (block.triangle[i] == kNone) continue;
    const std::uint32_t last = before;
    before = i;
    if (last == kNone || i - last > 2) continue;
    if (wanted[i] == kNone && wanted[last] == kNone) continue;
    for (std::uint32_t slot = i; slot < last + 3; ++slot) {
      const std::uint32_t here = value(i, slot), there = value(last, slot);
      if (here == there) continue;
      const std::uint32_t other = slot == i ? i + 1 : i;
      return {i, fits_between(here, there, value(i, other))};
    }
  }
  return {};
}

bool SequenceStrips::fits_between(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  std::array<std::uint32_t, 3> wanted{a, b, c};
  std::sort(wanted.begin(), wanted.end());
  return std::any_of(unplaced_.begin(), unplaced_.end(), [&](std::uint32_t t) {
    std::array<std::uint32_t, 3> has{};
    std::copy_n(corners_of(t), 3, has.begin());
    std::sort(has.begin(), has.end());
    return has == wanted;
  });
}

void SequenceStrips::set_slots(std::uint32_t b, const std::uint32_t* wanted) {
  const std::uint32_t count = blocks_[b].count;
  for (std::uint32_t i = 0; i + 2 < count; ++i) {
    if (wanted[i] == kNone) continue;
    for (std::uint32_t slot = i; slot < i + 3; ++slot)
      if (blocks_[b].slots[slot] == sequence_.target[wanted[i]])
        apply({BlockChange::kSet, static_cast<std::uint8_t>(slot), 0, b, wanted[i]});
  }
}

// Triangles without area that have got one are new ones. Returns the place of one that is not, or
// kNone.
std::uint32_t SequenceStrips::claim_new_triangles(std::uint32_t b) {
  const Block& block = blocks_[b];
  std::uint32_t begin = 0;
  for (std::uint32_t i = 0; i + 2 < block.count; ++i) {
    if (block.slots[i] == kStripRestart) begin = i + 1;
    if (block.triangle[i] != kNone || i < begin) continue;
    const auto corners = strip_triangle({block.slots + begin, block.count - begin}, i - begin);
    if (corners[2] == kStripRestart || corners[1] == kStripRestart || corners[0] == kStripRestart ||
        is_degenerate(corners))
      continue;
    const auto found = std::find_if(unplaced_.begin(), unplaced_.end(), [&](std::uint32_t t) {
      return same_triangle(corners, corners_of(t));
    });
    if (found == unplaced_.end()) return i;
    set_triangle(b, i, *found);
    unplaced_.erase(found);
  }
  return kNone;
}

// Takes its area from a triangle that should have none.
void SequenceStrips::break_run(std::uint32_t b, std::uint32_t place) {
  const std::uint32_t* const slots = blocks_[b].slots + place;
  if (strip_begin(blocks_[b], place) == place) {
    // The first slot belongs to no other triangle: it only repeats one of the next two.
    for (const std::uint32_t vertex : {slots[1], slots[2]}) {
      if (vertex < sequence_.vertices[level_] || sequence_.target[vertex] != slots[0]) continue;
      apply({BlockChange::kSet, static_cast<std::uint8_t>(place), 0, b, vertex});
      return;
    }
  }
  cut_strip(b, place + 1);
}

// Ends the strip before the triangle at `place` and lets the next one begin there. The slots that
// both need are repeated; one more keeps the orientation where that asks for it.
void SequenceStrips::cut_strip(std::uint32_t b, std::uint32_t place) {
  const Block& block = blocks_[b];
  const std::uint32_t begin = strip_begin(block, place);
  const std::uint32_t first = block.slots[place];
  std::uint32_t shared = 0;
  for (std::uint32_t back = 2; back > 0; --back)
    if (place >= begin + back && block.triangle[place - back] != kNone) shared = 3 - back;
  const auto insert = [&](std::uint32_t slot, std::uint32_t value) {
    apply({BlockChange::kInsert, static_cast<std::uint8_t>(slot), 0, b, value});
  };
  if (shared == 2) apply({BlockChange::kDuplicate, static_cast<std::uint8_t>(place), 0, b});
  if (shared == 1) insert(place, first);
  insert(place + shared, kStripRestart);
  if ((place - begin) % 2 == 1) insert(place + shared + 1, first);
}

bool SequenceStrips::make_room(std::uint32_t b, std::uint32_t slots) {
  if (blocks_[b].count + slots <= kMaxSlots) return false;
  const std::uint32_t at = best_split(blocks_[b]);
  const bool between = blocks_[b].slots[at - 1] == kStripRestart;
  apply({BlockChange::kSplit, static_cast<std::uint8_t>(at),
         between ? BlockChange::kBetween : BlockChange::kInside, b});
  return true;
}

// Where to split a full block: between strips if that is not too far from the middle, else inside
// one.
std::uint32_t SequenceStrips::best_split(const Block& block) const {
  constexpr std::uint32_t kCostOfCut = 20;
  std::uint32_t best = 0, begin = 0;
  std::uint32_t best_cost = kNone;
  for (std::uint32_t i = 1; i + 2 < block.count; ++i) {
    const bool between = block.slots[i - 1] == kStripRestart;
    if (between) begin = i;
    // Only an even number of slots keeps the orientation of what follows.
    const bool inside = i >= begin + 2 && (i - begin) % 2 == 0 && strip_end(block, i) >= i + 3;
    if (!between && !inside) continue;
    const std::uint32_t middle = block.count / 2;
    const std::uint32_t cost = (i > middle ? i - middle : middle - i) + (inside ? kCostOfCut : 0);
    if (cost >= best_cost) continue;
    best_cost = cost;
    best = i;
  }
  assert(best > 0);
  return best;
}

}  // namespace varifold
