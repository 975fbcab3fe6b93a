#include <varifold/models/lodstrips/block_form.h>
#include <varifold/models/lodstrips/block_records.h>
#include <algorithm>
#include <array>
#include <cassert>
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

BlockCursor::BlockCursor(const BlockForm& form, const LevelTable& levels,
                         const TriangleMesh& attributes, StripBuffer buffer)
    : form_(form), levels_(levels), buffer_(buffer), vertex_count_(levels.vertex_count(0)) {
  slots_.assign(form.buffer_size, kStripRestart);
  changed_slots_.reset(slots_.size());
  blocks_.resize(form.first.size());
  for (std::uint32_t b = 0; b < blocks_.size(); ++b) {
    const std::uint32_t range = form.range.empty() ? 0 : form.range[b];
    blocks_[b].first_index = form.first[b];
    blocks_[b].primitive = Primitive::kStrips;
    blocks_[b].material = attributes.ranges.empty() ? 0 : attributes.ranges[range].material;
  }
  const std::uint32_t* from = form.base_slots.data();
  for (const std::uint8_t count : form.base_counts) {
    DrawRange& block = blocks_[used_blocks_++];
    block.index_count = count;
    std::copy_n(from, count, slots_.begin() + block.first_index);
    from += count;
  }
  if (buffer_ == StripBuffer::kInPlace) return;
  compact_.resize(slots_.size() + blocks_.size());
  compact_ranges_.reserve(std::max<std::size_t>(1, attributes.ranges.size()));
}

void BlockCursor::go_to_level(std::uint32_t level) {
  level = std::min(level, levels_.finest_level());
  changed_ |= level != level_;
  while (level_ < level) split_once();
  while (level_ > level) collapse_once();
}

void BlockCursor::split_once() {
  const std::uint8_t* at = form_.records.data() + cursor_;
  const std::uint32_t size = form_.size_of_step(level_);
  const std::uint8_t* const end = at + size;
  const std::uint32_t last = blocks::last_bit(form_.id_bytes);
  while (at < end) {
    const std::uint32_t id = blocks::load_id(at, form_.id_bytes);
    at += form_.id_bytes;
    const std::uint8_t* group_end = end;
    if ((id & last) == 0) {
      group_end = at + 1 + *at;
      ++at;
    }
    do_group(id & (last - 1), at, group_end, vertex_count_);
    at = group_end;
  }
  cursor_ += size;
  vertex_count_ += levels_.step(level_).vertices;
  ++level_;
}

void BlockCursor::collapse_once() {
  --level_;
  vertex_count_ -= levels_.step(level_).vertices;
  const std::uint32_t size = form_.size_of_step(level_);
  cursor_ -= size;
  const std::uint8_t* at = form_.records.data() + cursor_;
  const std::uint8_t* const end = at + size;
  const std::uint32_t last = blocks::last_bit(form_.id_bytes);
  struct Group {
    std::uint32_t block;
    const std::uint8_t *begin, *at, *end;
  };
  // The last groups first; of a step with very many, so many at a time.
  constexpr std::size_t kMost = 16;
  std::array<Group, kMost> groups;
  for (const std::uint8_t* limit = end; limit > at;) {
    std::size_t count = 0;
    for (const std::uint8_t* group = at; group < limit;) {
      Group& found = groups[count++ % kMost];
      found.begin = group;
      const std::uint32_t id = blocks::load_id(group, form_.id_bytes);
      found.block = id & (last - 1);
      found.at = group + form_.id_bytes;
      found.end = end;
      if ((id & last) == 0) {
        found.end = found.at + 1 + *found.at;
        ++found.at;
      }
      group = found.end;
    }
    for (std::size_t i = 0; i < std::min(count, kMost); ++i) {
      const Group& group = groups[(count - 1 - i) % kMost];
      undo_group(group.block, group.at, group.end, vertex_count_);
      limit = group.begin;
    }
  }
}

void BlockCursor::do_group(std::uint32_t block, const std::uint8_t* at, const std::uint8_t* end,
                           std::uint32_t vertex) {
  DrawRange& range = blocks_[block];
  std::uint32_t* const slots = slots_.data() + range.first_index;
  while (at < end) {
    const Code code(*at++);
    switch (code.kind) {
      case blocks::kSet: slots[code.detail] = vertex; break;
      case blocks::kDuplicate: {
        std::uint32_t* const slot = slots + code.detail;
        std::memmove(slot + 2, slot, (range.index_count - code.detail) * sizeof(*slot));
        range.index_count += 2;
        break;
      }
      case blocks::kInsertTarget: insert(block, code.detail, levels_.target(vertex)); break;
      default: at = do_extended(block, at - 1, vertex); break;
    }
  }
  mark(block);
}

void BlockCursor::undo_group(std::uint32_t block, const std::uint8_t* at, const std::uint8_t* end,
                             std::uint32_t vertex) {
  mark(block);
  // Operations of one byte each can be read from the back.
  for (const std::uint8_t* look = at; look < end; ++look)
    if ((*look & 3u) == blocks::kExtended) return undo_mixed(block, at, end, vertex);
  std::uint32_t* const slots = slots_.data() + blocks_[block].first_index;
  while (end > at) {
    const Code code(*--end);
    if (code.kind == blocks::kSet)
      slots[code.detail] = levels_.target(vertex);
    else if (code.kind == blocks::kDuplicate)
      erase(block, code.detail + 2, 2);
    else
      erase(block, code.detail, 1);
  }
}

void BlockCursor::undo_mixed(std::uint32_t block, const std::uint8_t* at, const std::uint8_t* end,
                             std::uint32_t vertex) {
  // No group has more bytes than this; see StepWriter.
  std::array<std::uint8_t, 256> starts;
  std::array<std::uint32_t, 256> vertices;
  std::size_t count = 0;
  const std::uint32_t first = vertex;
  for (const std::uint8_t* look = at; look < end; look = next_operation(look)) {
    const Code code(*look);
    if (code.kind == blocks::kExtended && code.detail == blocks::kAdvance) vertex += look[1];
    if (code.kind == blocks::kExtended && code.detail == blocks::kFirst) vertex = first;
    vertices[count] = vertex;
    starts[count++] = static_cast<std::uint8_t>(look - at);
  }
  while (count-- > 0) {
    const std::uint8_t* const operation = at + starts[count];
    const Code code(*operation);
    switch (code.kind) {
      case blocks::kSet:
        slots_[blocks_[block].first_index + code.detail] = levels_.target(vertices[count]);
        break;
      case blocks::kDuplicate: erase(block, code.detail + 2, 2); break;
      case blocks::kInsertTarget: erase(block, code.detail, 1); break;
      default: undo_extended(block, operation); break;
    }
  }
}

// One operation; returns the next one.
const std::uint8_t* BlockCursor::do_extended(std::uint32_t block, const std::uint8_t* at,
                                             std::uint32_t& vertex) {
  DrawRange& range = blocks_[block];
  std::uint32_t* const slots = slots_.data() + range.first_index;
  const Code code(*at++);
  const auto open = [&](bool new_first, std::uint32_t value) {
    if (range.index_count > 0) slots[range.index_count++] = kStripRestart;
    const std::uint32_t target = levels_.target(vertex);
    slots[range.index_count++] = new_first ? vertex : target;
    slots[range.index_count++] = new_first ? target : vertex;
    slots[range.index_count++] = value;
  };
  switch (code.detail) {
    case blocks::kAdvance: vertex += at[0]; break;
    case blocks::kFirst: vertex = vertex_count_; break;
    case blocks::kOpenNewCopy: open(true, slots[at[0]]); break;
    case blocks::kOpenTargetCopy: open(false, slots[at[0]]); break;
    case blocks::kOpenNewValue: open(true, blocks::load_value(at)); break;
    case blocks::kOpenTargetValue: open(false, blocks::load_value(at)); break;
    case blocks::kInsertCopy: insert(block, at[0], slots[at[1]]); break;
    case blocks::kInsertRestart: insert(block, at[0], kStripRestart); break;
    case blocks::kInsertValue: insert(block, at[0], blocks::load_value(at + 1)); break;
    case blocks::kRotateOne:
    case blocks::kRotateTwo: {
      std::uint32_t* const slot = slots + at[0];
      std::rotate(slot, slot + (code.detail == blocks::kRotateOne ? 1 : 2), slot + 3);
      break;
    }
    case blocks::kReverse: std::reverse(slots + at[0], slots + at[0] + at[1]); break;
    case blocks::kSplitBetween: split_block(block, at[0], false); break;
    case blocks::kSplitInside: split_block(block, at[0], true); break;
    case blocks::kAssignCopy: slots[at[0]] = slots[at[1]]; break;
    case blocks::kAssignValue: slots[at[0]] = blocks::load_value(at + 1); break;
    case blocks::kNewBlock: ++used_blocks_; break;
    default: break;
  }
  return at + blocks::kPayload[code.detail];
}

void BlockCursor::undo_extended(std::uint32_t block, const std::uint8_t* at) {
  DrawRange& range = blocks_[block];
  std::uint32_t* const slots = slots_.data() + range.first_index;
  const Code code(*at++);
  switch (code.detail) {
    case blocks::kOpenNewCopy:
    case blocks::kOpenTargetCopy:
    case blocks::kOpenNewValue:
    case blocks::kOpenTargetValue: {
      const std::uint32_t slot_count = range.index_count > 3 ? 4 : 3;
      erase(block, range.index_count - slot_count, slot_count);
      break;
    }
    case blocks::kInsertCopy:
    case blocks::kInsertRestart:
    case blocks::kInsertValue: erase(block, at[0], 1); break;
    case blocks::kRotateOne:
    case blocks::kRotateTwo: {
      std::uint32_t* const slot = slots + at[0];
      std::rotate(slot, slot + (code.detail == blocks::kRotateOne ? 2 : 1), slot + 3);
      break;
    }
    case blocks::kReverse: std::reverse(slots + at[0], slots + at[0] + at[1]); break;
    case blocks::kSplitBetween: join_block(block, at[0], false); break;
    case blocks::kSplitInside: join_block(block, at[0], true); break;
    case blocks::kAssignCopy:
    case blocks::kAssignValue: slots[at[0]] = slots[at[0] + 1]; break;
    case blocks::kNewBlock: --used_blocks_; break;
    default: break;
  }
}

void BlockCursor::insert(std::uint32_t block, std::uint32_t slot, std::uint32_t value) {
  DrawRange& range = blocks_[block];
  std::uint32_t* const place = slots_.data() + range.first_index + slot;
  std::memmove(place + 1, place, (range.index_count - slot) * sizeof(*place));
  *place = value;
  ++range.index_count;
}

void BlockCursor::erase(std::uint32_t block, std::uint32_t slot, std::uint32_t count) {
  DrawRange& range = blocks_[block];
  std::uint32_t* const slots = slots_.data() + range.first_index;
  range.index_count -= count;
  std::memmove(slots + slot, slots + slot + count, (range.index_count - slot) * sizeof(*slots));
  std::fill_n(slots + range.index_count, count, kStripRestart);
}

// The new block may stand where this one reached before.
void BlockCursor::split_block(std::uint32_t block, std::uint32_t slot, bool inside) {
  DrawRange& left = blocks_[block];
  DrawRange& right = blocks_[used_blocks_++];
  const std::uint32_t from = left.first_index + slot;
  const std::uint32_t old_end = left.first_index + left.index_count;
  right.index_count = left.index_count - slot;
  left.index_count = inside ? slot + 2 : slot - 1;
  // What stays inside is copied before the rest moves over it.
  std::memmove(slots_.data() + right.first_index, slots_.data() + from,
               right.index_count * sizeof(std::uint32_t));
  const std::uint32_t left_end = left.first_index + left.index_count;
  for (std::uint32_t i = left_end; i < old_end; ++i)
    if (i < right.first_index || i >= right.first_index + right.index_count)
      slots_[i] = kStripRestart;
  changed_slots_.mark(left.first_index, old_end - left.first_index);
  changed_slots_.mark(right.first_index, right.index_count);
}

void BlockCursor::join_block(std::uint32_t block, std::uint32_t slot, bool inside) {
  DrawRange& left = blocks_[block];
  DrawRange& right = blocks_[--used_blocks_];
  const std::uint32_t to = left.first_index + slot;
  const std::uint32_t right_end = right.first_index + right.index_count;
  std::memmove(slots_.data() + to, slots_.data() + right.first_index,
               right.index_count * sizeof(std::uint32_t));
  if (!inside) slots_[to - 1] = kStripRestart;
  left.index_count = slot + right.index_count;
  const std::uint32_t end = left.first_index + left.index_count;
  for (std::uint32_t i = std::max(end, right.first_index); i < right_end; ++i)
    slots_[i] = kStripRestart;
  changed_slots_.mark(left.first_index, left.index_count);
  changed_slots_.mark(right.first_index, right.index_count);
  right.index_count = 0;
}

void BlockCursor::mark(std::uint32_t block) {
  const std::uint32_t first = blocks_[block].first_index;
  changed_slots_.mark(first);
  changed_slots_.mark(std::min(first + BlockForm::kMaxSlots, form_.buffer_size) - 1);
}

// All blocks one after the other, by material.
void BlockCursor::fill_compact() {
  const std::uint32_t range_count =
      form_.range.empty() ? 1 : 1 + *std::max_element(form_.range.begin(), form_.range.end());
  compact_ranges_.clear();
  std::uint32_t* to = compact_.data();
  for (std::uint32_t r = 0; r < range_count; ++r) {
    DrawRange range;
    range.first_index = static_cast<std::uint32_t>(to - compact_.data());
    range.primitive = Primitive::kStrips;
    for (std::uint32_t b = 0; b < used_blocks_; ++b) {
      const DrawRange& block = blocks_[b];
      if (block.index_count == 0 || (range_count > 1 && form_.range[b] != r)) continue;
      std::memcpy(to, slots_.data() + block.first_index,
                  block.index_count * sizeof(std::uint32_t));
      to += block.index_count;
      *to++ = kStripRestart;
      range.material = block.material;
    }
    const auto end = static_cast<std::uint32_t>(to - compact_.data());
    if (end == range.first_index) continue;
    range.index_count = end - 1 - range.first_index;
    compact_ranges_.push_back(range);
  }
  const auto size = static_cast<std::uint32_t>(to - compact_.data());
  compact_changed_ = {0, size};
}

void BlockCursor::fill(DrawList& list) {
  if (buffer_ == StripBuffer::kInPlace) {
    list.indices = slots_;
    list.ranges = {blocks_.data(), used_blocks_};
    list.changed_indices = changed_slots_.take();
    return;
  }
  if (changed_) fill_compact();
  list.indices = {compact_.data(), compact_changed_.count};
  list.ranges = compact_ranges_;
  list.changed_indices = {&compact_changed_, changed_ ? std::size_t{1} : 0};
  changed_ = false;
}

std::size_t BlockCursor::bytes() const {
  return (slots_.size() + compact_.size()) * sizeof(std::uint32_t) +
         blocks_.size() * sizeof(DrawRange) + changed_slots_.bytes();
}

}  // namespace varifold
