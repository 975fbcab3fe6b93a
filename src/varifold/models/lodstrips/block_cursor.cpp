#include <varifold/models/lodstrips/block_form.h>
#include <varifold/models/lodstrips/block_records.h>
#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

namespace varifold {

namespace {

// Slots are moved in chunks of this many; what a chunk covers beyond its end is put back.
constexpr std::uint32_t kChunk = 16;
struct Chunk {
  std::uint32_t slots[kChunk];
};
Chunk load_chunk(const std::uint32_t* at) {
  Chunk chunk;
  std::memcpy(&chunk, at, sizeof(chunk));
  return chunk;
}
void store_chunk(std::uint32_t* at, const Chunk& chunk) { std::memcpy(at, &chunk, sizeof(chunk)); }

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
void set_slots(std::uint32_t* slots, const std::uint8_t* at, std::uint32_t count,
               std::uint32_t value) {
  if (count == 0) return;
  const std::uint32_t last = count - 1;
  slots[at[0]] = value;
  slots[at[std::min(1u, last)]] = value;
  slots[at[std::min(2u, last)]] = value;
  for (std::uint32_t i = 3; i < count; ++i) slots[at[i]] = value;
}

struct Code {
  std::uint32_t kind, detail;
  explicit Code(std::uint8_t byte) : kind(byte & 3u), detail(byte >> 2u) {}
};

const std::uint8_t* next_operation(const std::uint8_t* at) {
  const Code code(*at);
  return at + 1 + (code.kind == blocks::kExtended ? blocks::kPayload[code.detail] : 0);
}

}  // namespace

// The block that a group changes.
struct BlockCursor::Place {
  std::uint8_t& count;
  std::uint32_t* slots;

  [[nodiscard]] std::uint32_t* end() const { return slots + count; }
  void duplicate(std::uint32_t slot) {
    move_up<2>(slots + slot, end());
    count = static_cast<std::uint8_t>(count + 2);
  }
  void insert(std::uint32_t slot, std::uint32_t value) {
    move_up<1>(slots + slot, end());
    slots[slot] = value;
    ++count;
  }
  void erase_one(std::uint32_t slot) {
    move_down<1>(slots + slot, end());
    --count;
  }
  void erase_two(std::uint32_t slot) {
    move_down<2>(slots + slot, end());
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

BlockCursor::Place BlockCursor::place(std::uint32_t block) {
  const std::uint32_t first = form_.first[block];
  changed_slots_.mark(first);
  return {counts_[block], slots_.data() + kChunk + first};
}

BlockCursor::BlockCursor(const BlockForm& form, const LevelTable& levels,
                         const TriangleMesh& attributes, StripBuffer buffer)
    : form_(form), levels_(levels), buffer_(buffer), vertex_count_(levels.vertex_count(0)) {
  slots_.assign(form.buffer_size + std::size_t{2} * kChunk, kStripRestart);
  changed_slots_.reset(form.buffer_size);
  counts_.assign(form.first.size(), 0);
  const std::uint32_t* from = form.base_slots.data();
  for (const std::uint8_t count : form.base_counts) {
    std::copy_n(from, count, place(used_blocks_).slots);
    counts_[used_blocks_++] = count;
    from += count;
  }
  for (const MaterialRange& range : attributes.ranges) materials_.push_back(range.material);
  if (materials_.empty()) materials_.push_back(0);
  ranges_.reserve(buffer_ == StripBuffer::kInPlace ? counts_.size() : materials_.size());
  if (buffer_ == StripBuffer::kInPlace) return;
  compact_.resize(form.buffer_size + counts_.size());
}

void BlockCursor::go_to_level(std::uint32_t level) {
  level = std::min(level, levels_.finest_level());
  changed_ |= level != level_;
  if (form_.word_bytes == 3) {
    while (level_ < level) split_once<3>();
    while (level_ > level) collapse_once<3>();
  } else {
    while (level_ < level) split_once<4>();
    while (level_ > level) collapse_once<4>();
  }
}

template <std::uint32_t kWordBytes>
void BlockCursor::split_once() {
  const std::uint8_t* at = form_.records.data() + cursor_;
  const std::uint32_t size = form_.size_of_step(level_);
  const std::uint8_t* const end = at + size;
  const std::uint32_t vertex = vertex_count_;
  while (at < end) {
    const blocks::Group group(at, blocks::WordFormat(kWordBytes));
    at += kWordBytes;
    Place place = this->place(group.block);
    for (std::uint32_t i = 0; i < group.duplicates; ++i) place.duplicate(*at++);
    set_slots(place.slots, at, group.sets, vertex);
    at += group.sets;
    if (group.rest == blocks::kNothing) continue;
    if (group.rest == blocks::kMixed) {
      const std::uint8_t* const rest_end = at + 1 + *at;
      do_mixed(place, at + 1, rest_end, vertex);
      at = rest_end;
    } else if (group.rest >= blocks::kOpened) {
      const std::uint32_t order = (*at & 3u) + (group.rest == blocks::kOpenedHigh ? 4 : 0);
      place.open(order, vertex, levels_.target(vertex), place.slots[*at >> 2u]);
      ++at;
    } else {
      place.insert(*at++, group.rest == blocks::kVertexInserted ? vertex : levels_.target(vertex));
    }
  }
  cursor_ += size;
  vertex_count_ += levels_.step(level_).vertices;
  ++level_;
}

template <std::uint32_t kWordBytes>
void BlockCursor::collapse_once() {
  const blocks::WordFormat format(kWordBytes);
  --level_;
  vertex_count_ -= levels_.step(level_).vertices;
  const std::uint32_t size = form_.size_of_step(level_);
  cursor_ -= size;
  const std::uint8_t* const begin = form_.records.data() + cursor_;
  // The last groups first; of a step with very many, so many at a time.
  constexpr std::size_t kMost = 16;
  std::array<const std::uint8_t*, kMost> groups;
  for (const std::uint8_t* limit = begin + size; limit > begin;) {
    std::size_t count = 0;
    for (const std::uint8_t* at = begin; at < limit;) {
      groups[count++ % kMost] = at;
      at = blocks::Group(at, format).end(at + kWordBytes);
    }
    for (std::size_t i = 0; i < std::min(count, kMost); ++i) {
      limit = groups[(count - 1 - i) % kMost];
      undo_group(blocks::Group(limit, format), limit + kWordBytes);
    }
  }
}

inline void BlockCursor::undo_group(const blocks::Group& group, const std::uint8_t* at) {
  const std::uint32_t vertex = vertex_count_;
  const std::uint8_t* const sets = at + group.duplicates;
  const std::uint8_t* const rest = sets + group.sets;
  Place place = this->place(group.block);
  if (group.rest == blocks::kMixed)
    undo_mixed(place, rest + 1, rest + 1 + *rest, vertex);
  else if (group.rest >= blocks::kOpened)
    place.undo_open();
  else if (group.rest != blocks::kNothing)
    place.erase_one(*rest);
  const std::uint32_t target = levels_.target(vertex);
  set_slots(place.slots, sets, group.sets, target);
  for (std::uint32_t i = group.duplicates; i-- > 0;) place.erase_two(at[i] + 2u);
}

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

// One range a block.
void BlockCursor::fill_in_place() {
  ranges_.clear();
  for (std::uint32_t b = 0; b < used_blocks_; ++b)
    if (counts_[b] > 0)
      ranges_.push_back({form_.first[b], counts_[b], Primitive::kStrips, materials_[range_of(b)]});
}

// All blocks one after the other, by material.
void BlockCursor::fill_compact() {
  ranges_.clear();
  std::uint32_t* to = compact_.data();
  for (std::uint32_t r = 0; r < materials_.size(); ++r) {
    const auto first = static_cast<std::uint32_t>(to - compact_.data());
    for (std::uint32_t b = 0; b < used_blocks_; ++b) {
      if (counts_[b] == 0 || range_of(b) != r) continue;
      std::memcpy(to, slots_.data() + kChunk + form_.first[b], counts_[b] * sizeof(std::uint32_t));
      to += counts_[b];
      *to++ = kStripRestart;
    }
    const auto end = static_cast<std::uint32_t>(to - compact_.data());
    if (end > first) ranges_.push_back({first, end - 1 - first, Primitive::kStrips, materials_[r]});
  }
  compact_changed_ = {0, static_cast<std::uint32_t>(to - compact_.data())};
}

std::span<const std::uint32_t> BlockCursor::slots() const {
  return {slots_.data() + kChunk, form_.buffer_size};
}

void BlockCursor::fill(DrawList& list) {
  if (buffer_ == StripBuffer::kInPlace) {
    if (changed_) fill_in_place();
    list.indices = slots();
    list.changed_indices = changed_slots_.take(BlockForm::kMaxSlots);
  } else {
    if (changed_) fill_compact();
    list.indices = {compact_.data(), compact_changed_.count};
    list.changed_indices = {&compact_changed_, changed_ ? std::size_t{1} : 0};
  }
  list.ranges = ranges_;
  const std::uint32_t finest = levels_.finest_level();
  const float fraction = finest > 0 ? static_cast<float>(level_) / static_cast<float>(finest) : 1;
  for (DrawRange& range : ranges_) range.level = fraction;
  changed_ = false;
}

std::size_t BlockCursor::bytes() const {
  return (slots_.size() + compact_.size()) * sizeof(std::uint32_t) + counts_.size() +
         ranges_.capacity() * sizeof(DrawRange) + changed_slots_.bytes();
}

}  // namespace varifold
