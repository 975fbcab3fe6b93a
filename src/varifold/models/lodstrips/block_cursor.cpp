// Going from level to level: the groups of a step, and most of what they say.
#include <varifold/models/lodstrips/block_cursor.h>

#include <varifold/models/lodstrips/block_place.h>
#include <varifold/models/lodstrips/block_records.h>
#include <algorithm>
#include <array>

namespace varifold {

BlockCursor::BlockCursor(const BlockForm& form, const LevelTable& levels,
                         const TriangleMesh& attributes, StripBuffer buffer)
    : form_(form), levels_(levels), buffer_(buffer), vertex_count_(levels.vertex_count(0)) {
  slots_.assign(form.buffer_size + std::size_t{2} * blocks::kChunk, kStripRestart);
  changed_slots_.reset(form.buffer_size);
  counts_.assign(form.first.size(), 0);
  touched_.assign(((counts_.size() >> kGroupBits) | (sizeof(std::uint64_t) - 1)) + 1, 0);
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
  compact_end_.resize(materials_.size());
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
    blocks::set_slots(place.slots, at, group.sets, vertex);
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
  blocks::set_slots(place.slots, sets, group.sets, target);
  for (std::uint32_t i = group.duplicates; i-- > 0;) place.erase_two(at[i] + 2u);
}

std::span<const std::uint32_t> BlockCursor::slots() const {
  return {slots_.data() + blocks::kChunk, form_.buffer_size};
}

std::size_t BlockCursor::bytes() const {
  return (slots_.size() + compact_.size()) * sizeof(std::uint32_t) + counts_.size() +
         touched_.size() + ranges_.capacity() * sizeof(DrawRange) + changed_slots_.bytes();
}

}  // namespace varifold
