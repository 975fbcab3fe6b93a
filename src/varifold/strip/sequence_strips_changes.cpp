// The changes of blocks, one by one.
#include <varifold/strip/sequence_strips.h>

#include <algorithm>
#include <cassert>
#include <cstring>

namespace varifold {

std::uint32_t SequenceStrips::place_of(const Block& block, std::uint32_t triangle) {
  const std::uint32_t* const found =
      std::find(block.triangle, block.triangle + block.count, triangle);
  assert(found != block.triangle + block.count);
  return static_cast<std::uint32_t>(found - block.triangle);
}

std::uint32_t SequenceStrips::strip_begin(const Block& block, std::uint32_t place) {
  while (place > 0 && block.slots[place - 1] != kStripRestart) --place;
  return place;
}

std::uint32_t SequenceStrips::strip_end(const Block& block, std::uint32_t place) {
  while (place < block.count && block.slots[place] != kStripRestart) ++place;
  return place;
}

void SequenceStrips::set_triangle(std::uint32_t b, std::uint32_t place, std::uint32_t triangle) {
  blocks_[b].triangle[place] = triangle;
  block_of_[triangle] = b;
}

void SequenceStrips::new_block(std::uint32_t range) {
  blocks_.emplace_back();
  blocks_.back().range = range;
}

void SequenceStrips::apply(const BlockChange& change) {
  changes_.push_back(change);
  if (change.kind == BlockChange::kNewBlock) return new_block(change.value);
  if (change.kind == BlockChange::kSplit) return split_block(change);
  Block& block = blocks_[change.block];
  const std::uint32_t* const begin = block.slots;
  const std::uint32_t* const end = begin + block.count;
  const std::uint32_t* const copy = std::find(begin, end, change.value);
  if (copy != end) changes_.back().from = static_cast<std::uint8_t>(copy - begin);
  std::uint32_t* const slot = block.slots + change.slot;
  std::uint32_t* const triangle = block.triangle + change.slot;
  // Moves the slots from this one on by `by`, and the triangles that begin there.
  const auto move = [&](std::uint32_t by) {
    const std::uint32_t behind = block.count - change.slot;
    assert(block.count + by <= kMaxSlots);
    std::memmove(slot + by, slot, behind * sizeof(*slot));
    std::memmove(triangle + by, triangle, behind * sizeof(*triangle));
    std::fill_n(triangle, by, kNone);
    block.count += by;
  };
  switch (change.kind) {
    case BlockChange::kSet:
    case BlockChange::kAssign:
      *slot = change.value;
      break;
    case BlockChange::kDuplicate:
      move(2);
      std::copy_n(slot + 2, 2, slot);
      break;
    case BlockChange::kInsert:
      move(1);
      *slot = change.value;
      break;
    case BlockChange::kOpen: {
      move(block.count > 0 ? 4 : 3);
      std::uint32_t* first = slot;
      if (change.slot > 0) *first++ = kStripRestart;
      const std::uint32_t place = change.detail / 2;
      const bool target_first = change.detail % 2 == 1;
      const std::uint32_t target = sequence_.target[change.vertex];
      first[place] = change.value;
      first[place == 0 ? 1 : 0] = target_first ? target : change.vertex;
      first[place == 2 ? 1 : 2] = target_first ? change.vertex : target;
      break;
    }
    case BlockChange::kRotate:
      std::rotate(slot, slot + change.detail, slot + 3);
      break;
    case BlockChange::kReverse:
      std::reverse(slot, slot + change.detail);
      std::reverse(triangle, triangle + change.detail - 2);
      break;
    default:
      break;
  }
  block.most = std::max(block.most, block.count);
}

void SequenceStrips::split_block(const BlockChange& change) {
  const std::uint32_t at = change.slot;
  new_block(blocks_[change.block].range);
  Block& left = blocks_[change.block];
  Block& right = blocks_.back();
  right.count = right.most = left.count - at;
  std::copy_n(left.slots + at, right.count, right.slots);
  std::fill_n(right.triangle, right.count, kNone);
  for (std::uint32_t i = 0; i < right.count; ++i)
    if (left.triangle[at + i] != kNone) set_triangle(block_count() - 1, i, left.triangle[at + i]);
  left.count = change.detail == BlockChange::kBetween ? at - 1 : at + 2;
  std::fill(left.triangle + std::min(at, left.count), left.triangle + kMaxSlots, kNone);
  splits_.push_back({left.most, block_count() - 1, left.last_split});
  left.last_split = static_cast<std::uint32_t>(splits_.size() - 1);
  left.most = left.count;
}

SequenceStrips::Layout SequenceStrips::layout() const {
  // First the place of every child within the region of its parent, children before parents.
  Layout layout;
  layout.first.assign(block_count(), 0);
  std::vector<std::uint32_t> region(block_count());
  std::vector<std::uint32_t> parent(block_count(), kNone);
  for (std::uint32_t b = block_count(); b-- > 0;) {
    std::uint32_t most = blocks_[b].most;
    std::uint32_t end = most;
    for (std::uint32_t s = blocks_[b].last_split; s != kNone; s = splits_[s].previous) {
      const std::uint32_t child = splits_[s].child;
      parent[child] = b;
      layout.first[child] = std::max(end, most);
      end = layout.first[child] + region[child];
      most = splits_[s].most;
    }
    region[b] = std::max(end, most);
  }
  for (std::uint32_t b = 0; b < block_count(); ++b) {
    if (parent[b] != kNone) {
      layout.first[b] += layout.first[parent[b]];
    } else {
      layout.first[b] = layout.size;
      layout.size += region[b];
    }
  }
  return layout;
}

}  // namespace varifold
