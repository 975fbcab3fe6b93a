// The operations of mixed groups: the rarer changes of blocks.
#include <varifold/models/lodstrips/block_place.h>
#include <varifold/models/lodstrips/block_records.h>
#include <algorithm>
#include <array>
#include <cstring>

namespace varifold {

namespace {

struct Code {
  std::uint32_t kind, detail;
  explicit Code(std::uint8_t byte) : kind(byte & 3u), detail(byte >> 2u) {}
};

const std::uint8_t* next_operation(const std::uint8_t* at) {
  const Code code(*at);
  return at + 1 + (code.kind == blocks::kExtended ? blocks::kPayload[code.detail] : 0);
}

}  // namespace

void BlockCursor::do_mixed(Place place, const std::uint8_t* at, const std::uint8_t* end,
                           std::uint32_t vertex) {
  while (at < end) {
    const Code code(*at);
    switch (code.kind) {
      case blocks::kSet:
        place.slots[code.detail] = vertex;
        break;
      case blocks::kDuplicate:
        place.duplicate(code.detail);
        break;
      case blocks::kInsertTarget:
        place.insert(code.detail, levels_.target(vertex));
        break;
      default:
        if (code.detail == blocks::kAdvance) vertex += at[1];
        if (code.detail == blocks::kFirst) vertex = vertex_count_;
        do_extended(place, at, vertex);
        break;
    }
    at = next_operation(at);
  }
}

void BlockCursor::undo_mixed(Place place, const std::uint8_t* at, const std::uint8_t* end,
                             std::uint32_t vertex) {
  // Operations are found from the front and undone from the back.
  std::array<std::uint8_t, 256> starts;
  std::array<std::uint32_t, 256> vertices;
  std::size_t count = 0;
  for (const std::uint8_t* look = at; look < end; look = next_operation(look)) {
    const Code code(*look);
    if (code.kind == blocks::kExtended && code.detail == blocks::kAdvance) vertex += look[1];
    if (code.kind == blocks::kExtended && code.detail == blocks::kFirst) vertex = vertex_count_;
    vertices[count] = vertex;
    starts[count++] = static_cast<std::uint8_t>(look - at);
  }
  while (count-- > 0) {
    const std::uint8_t* const operation = at + starts[count];
    const Code code(*operation);
    switch (code.kind) {
      case blocks::kSet:
        place.slots[code.detail] = levels_.target(vertices[count]);
        break;
      case blocks::kDuplicate:
        place.erase_two(code.detail + 2);
        break;
      case blocks::kInsertTarget:
        place.erase_one(code.detail);
        break;
      default:
        undo_extended(place, operation);
        break;
    }
  }
}

void BlockCursor::do_extended(Place place, const std::uint8_t* at, std::uint32_t vertex) {
  std::uint32_t* const slots = place.slots;
  const Code code(*at++);
  switch (code.detail) {
    case blocks::kOpenCopy:
      place.open(at[0], vertex, levels_.target(vertex), slots[at[1]]);
      break;
    case blocks::kOpenValue:
      place.open(at[0], vertex, levels_.target(vertex), blocks::load_value(at + 1));
      break;
    case blocks::kInsertCopy:
      place.insert(at[0], slots[at[1]]);
      break;
    case blocks::kInsertRestart:
      place.insert(at[0], kStripRestart);
      break;
    case blocks::kInsertValue:
      place.insert(at[0], blocks::load_value(at + 1));
      break;
    case blocks::kRotateOne:
      std::rotate(slots + at[0], slots + at[0] + 1, slots + at[0] + 3);
      break;
    case blocks::kRotateTwo:
      std::rotate(slots + at[0], slots + at[0] + 2, slots + at[0] + 3);
      break;
    case blocks::kReverse:
      std::reverse(slots + at[0], slots + at[0] + at[1]);
      break;
    case blocks::kSplitBetween:
      split_block(place, at[0], false);
      break;
    case blocks::kSplitInside:
      split_block(place, at[0], true);
      break;
    case blocks::kAssignCopy:
      slots[at[0]] = slots[at[1]];
      break;
    case blocks::kAssignValue:
      slots[at[0]] = blocks::load_value(at + 1);
      break;
    case blocks::kNewBlock:
      ++used_blocks_;
      break;
    default:
      break;
  }
}

void BlockCursor::undo_extended(Place place, const std::uint8_t* at) {
  std::uint32_t* const slots = place.slots;
  const Code code(*at++);
  switch (code.detail) {
    case blocks::kOpenCopy:
    case blocks::kOpenValue:
      place.undo_open();
      break;
    case blocks::kInsertCopy:
    case blocks::kInsertRestart:
    case blocks::kInsertValue:
      place.erase_one(at[0]);
      break;
    case blocks::kRotateOne:
      std::rotate(slots + at[0], slots + at[0] + 2, slots + at[0] + 3);
      break;
    case blocks::kRotateTwo:
      std::rotate(slots + at[0], slots + at[0] + 1, slots + at[0] + 3);
      break;
    case blocks::kReverse:
      std::reverse(slots + at[0], slots + at[0] + at[1]);
      break;
    case blocks::kSplitBetween:
      join_block(place, at[0], false);
      break;
    case blocks::kSplitInside:
      join_block(place, at[0], true);
      break;
    case blocks::kAssignCopy:
    case blocks::kAssignValue:
      slots[at[0]] = slots[at[0] + 1];
      break;
    case blocks::kNewBlock:
      --used_blocks_;
      break;
    default:
      break;
  }
}

// The new block may stand where this one reached before.
void BlockCursor::split_block(Place place, std::uint32_t slot, bool inside) {
  Place right = this->place(used_blocks_++);
  std::uint32_t* const old_end = place.end();
  right.count = static_cast<std::uint8_t>(place.count - slot);
  place.count = static_cast<std::uint8_t>(inside ? slot + 2 : slot - 1);
  std::memmove(right.slots, place.slots + slot, right.count * sizeof(std::uint32_t));
  std::uint32_t* const gap_end = std::min(right.slots, old_end);
  if (place.end() < gap_end) std::fill(place.end(), gap_end, kStripRestart);
  if (right.end() < old_end) std::fill(right.end(), old_end, kStripRestart);
}

void BlockCursor::join_block(Place place, std::uint32_t slot, bool inside) {
  Place right = this->place(--used_blocks_);
  std::uint32_t* const right_end = right.end();
  std::memmove(place.slots + slot, right.slots, right.count * sizeof(std::uint32_t));
  if (!inside) place.slots[slot - 1] = kStripRestart;
  place.count = static_cast<std::uint8_t>(slot + right.count);
  std::uint32_t* const rest = std::max(place.end(), right.slots);
  if (rest < right_end) std::fill(rest, right_end, kStripRestart);
  right.count = 0;
}

}  // namespace varifold
