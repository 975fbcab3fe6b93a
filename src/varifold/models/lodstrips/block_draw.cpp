// What is drawn of the blocks of a level.
#include <varifold/models/lodstrips/block_place.h>
#include <algorithm>
#include <cstring>

namespace varifold {

// One range a block. Which blocks are in use changes at the end alone.
void BlockCursor::update_ranges() {
  while (ranges_.size() > used_blocks_) ranges_.pop_back();
  while (ranges_.size() < used_blocks_) {
    const auto b = static_cast<std::uint32_t>(ranges_.size());
    ranges_.push_back({form_.first[b], counts_[b], Primitive::kStrips, materials_[range_of(b)]});
  }
  constexpr std::size_t kWord = sizeof(std::uint64_t);
  for (std::size_t at = 0; at < touched_.size(); at += kWord) {
    std::uint64_t word = 0;
    std::memcpy(&word, touched_.data() + at, kWord);
    if (word == 0) continue;
    for (std::size_t group = at; group < at + kWord; ++group) {
      if (touched_[group] == 0) continue;
      const std::size_t first = group << kGroupBits;
      const std::size_t end = std::min(first + (std::size_t{1} << kGroupBits), ranges_.size());
      for (std::size_t b = first; b < end; ++b) ranges_[b].index_count = counts_[b];
    }
    std::memset(touched_.data() + at, 0, kWord);
  }
}

// All blocks one after the other, by material.
void BlockCursor::fill_compact() {
  std::vector<std::uint32_t>& end = compact_end_;
  std::fill(end.begin(), end.end(), 0);
  for (std::uint32_t b = 0; b < used_blocks_; ++b)
    if (counts_[b] > 0) end[range_of(b)] += counts_[b] + 1u;
  ranges_.clear();
  std::uint32_t first = 0;
  for (std::size_t r = 0; r < end.size(); ++r) {
    const std::uint32_t size = end[r];
    if (size > 0) ranges_.push_back({first, size - 1, Primitive::kStrips, materials_[r]});
    end[r] = first;
    first += size;
  }
  for (std::uint32_t b = 0; b < used_blocks_; ++b) {
    if (counts_[b] == 0) continue;
    std::uint32_t& to = end[range_of(b)];
    std::memcpy(compact_.data() + to, slots().data() + form_.first[b],
                counts_[b] * sizeof(std::uint32_t));
    to += counts_[b];
    compact_[to++] = kStripRestart;
  }
  compact_changed_ = {0, first};
}

void BlockCursor::fill(DrawList& list) {
  if (buffer_ == StripBuffer::kInPlace) {
    if (changed_) update_ranges();
    list.indices = slots();
    list.changed_indices = changed_slots_.take(BlockForm::kMaxSlots);
  } else {
    if (changed_) fill_compact();
    list.indices = {compact_.data(), compact_changed_.count};
    list.changed_indices = {&compact_changed_, changed_ ? std::size_t{1} : 0};
  }
  list.ranges = ranges_;
  changed_ = false;
}

}  // namespace varifold
