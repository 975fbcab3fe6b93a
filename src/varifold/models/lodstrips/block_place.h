// How the slots of one block move; for the sources of BlockCursor.
#pragma once

#include <varifold/models/lodstrips/block_cursor.h>
#include <algorithm>
#include <cstdint>
#include <cstring>

namespace varifold {

namespace blocks {

// Slots are moved in chunks of this many; what a chunk covers beyond its end is put back.
inline constexpr std::uint32_t kChunk = 16;
struct Chunk {
  std::uint32_t slots[kChunk];
};
inline Chunk load_chunk(const std::uint32_t* at) {
  Chunk chunk;
  std::memcpy(&chunk, at, sizeof(chunk));
  return chunk;
}
inline void store_chunk(std::uint32_t* at, const Chunk& chunk) {
  std::memcpy(at, &chunk, sizeof(chunk));
}

// Moves [slot, end) up by one or two; [slot, slot + by) keep what they had. Fewer branches than
// memmove, whose time goes into finding out how little there is to move. Touches, but does not
// change, kChunk slots before `slot`.
template <std::uint32_t kBy>
void move_up(std::uint32_t* slot, std::uint32_t* end) {
  const Chunk before = load_chunk(slot + kBy - kChunk);
  while (end > slot) {
    end -= kChunk;
    store_chunk(end + kBy, load_chunk(end));
  }
  store_chunk(slot + kBy - kChunk, before);
}

// Moves [slot + by, end) down to `slot`; the last `by` slots become restarts. Touches, but does not
// change, kChunk slots from `end` on.
template <std::uint32_t kBy>
void move_down(std::uint32_t* slot, std::uint32_t* end) {
  const Chunk behind = load_chunk(end);
  for (; slot + kBy < end; slot += kChunk) store_chunk(slot, load_chunk(slot + kBy));
  store_chunk(end, behind);
  for (std::uint32_t i = 1; i <= kBy; ++i) *(end - i) = kStripRestart;
}

// One to three slots, nearly always, cost no branch: the last one is set again.
inline void set_slots(std::uint32_t* slots, const std::uint8_t* at, std::uint32_t count,
                      std::uint32_t value) {
  if (count == 0) return;
  const std::uint32_t last = count - 1;
  slots[at[0]] = value;
  slots[at[std::min(1u, last)]] = value;
  slots[at[std::min(2u, last)]] = value;
  for (std::uint32_t i = 3; i < count; ++i) slots[at[i]] = value;
}

}  // namespace blocks

// The block that a group changes.
struct BlockCursor::Place {
  std::uint8_t& count;
  std::uint32_t* slots;

  [[nodiscard]] std::uint32_t* end() const { return slots + count; }
  void duplicate(std::uint32_t slot) {
    blocks::move_up<2>(slots + slot, end());
    count = static_cast<std::uint8_t>(count + 2);
  }
  void insert(std::uint32_t slot, std::uint32_t value) {
    blocks::move_up<1>(slots + slot, end());
    slots[slot] = value;
    ++count;
  }
  void erase_one(std::uint32_t slot) {
    blocks::move_down<1>(slots + slot, end());
    --count;
  }
  void erase_two(std::uint32_t slot) {
    blocks::move_down<2>(slots + slot, end());
    count = static_cast<std::uint8_t>(count - 2);
  }
  // A strip of one triangle after the others.
  void open(std::uint32_t order, std::uint32_t vertex, std::uint32_t target, std::uint32_t value) {
    std::uint32_t* to = end();
    if (count > 0) *to++ = kStripRestart;
    const std::uint32_t place = order / 2;
    const bool target_first = order % 2 == 1;
    to[place == 0 ? 1 : 0] = target_first ? target : vertex;
    to[place == 2 ? 1 : 2] = target_first ? vertex : target;
    to[place] = value;
    count = static_cast<std::uint8_t>(to + 3 - slots);
  }
  void undo_open() { pop(count > 3 ? 4 : 3); }
  void pop(std::uint32_t slot_count) {
    std::fill_n(end() - slot_count, slot_count, kStripRestart);
    count = static_cast<std::uint8_t>(count - slot_count);
  }
};

inline BlockCursor::Place BlockCursor::place(std::uint32_t block) {
  const std::uint32_t first = form_.first[block];
  changed_slots_.mark(first);
  touched_[block >> kGroupBits] = 1;
  return {counts_[block], slots_.data() + blocks::kChunk + first};
}

}  // namespace varifold
