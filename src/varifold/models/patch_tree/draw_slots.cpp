#include <varifold/models/patch_tree/draw_slots.h>

#include <varifold/models/patch_tree/extract.h>
#include <varifold/view/draw_vertices.h>
#include <algorithm>
#include <utility>

namespace varifold {

DrawSlots::DrawSlots(std::shared_ptr<const PatchTree> tree) : tree_(std::move(tree)) {
  const PatchTreeData& data = tree_->data();
  slots_.reserve(data.ranges.size());
  auto index = static_cast<std::uint32_t>(data.corners.size());
  for (const PatchRange& range : data.ranges) {
    slots_.push_back({index, 0});
    index += 3 * (range.triangle_count - range.constant_triangles);
  }
  indices_.resize(index);
  written_.resize(tree_->node_count(), 0);
  level_of_.reserve(tree_->node_count());
  for (std::uint32_t node = 0; node < tree_->node_count(); ++node) {
    const PatchOffsets& at = data.offsets[node];
    for (std::size_t i = 3 * std::size_t{at.triangle};
         i < 3 * std::size_t{data.offsets[node + 1].triangle}; ++i)
      indices_[i] = at.vertex + data.corners[i];
    level_of_.push_back(static_cast<std::uint8_t>(std::min(tree_->level_of(node), 255u)));
  }
}

void DrawSlots::mark(std::span<const std::uint32_t> places) {
  for (const std::uint32_t place : places) {
    if (place >= is_marked_.size()) is_marked_.resize(place + std::size_t{1}, 0);
    if (is_marked_[place] == 0) marked_.push_back(place);
    is_marked_[place] = 1;
  }
}

// The border triangles of a draw that is switched.
void DrawSlots::write(const PatchDraw& draw) {
  const PatchTreeData& data = tree_->data();
  const PatchOffsets& at = data.offsets[draw.node];
  std::size_t triangle = at.triangle;
  for (std::uint32_t r = at.range; r < data.offsets[draw.node + 1].range; ++r) {
    const PatchRange& range = data.ranges[r];
    Slot& slot = slots_[r];
    std::uint32_t to = slot.first_index;
    for (std::size_t t = triangle + range.constant_triangles; t < triangle + range.triangle_count;
         ++t) {
      std::uint32_t drawn[3];
      for (std::size_t k = 0; k < 3; ++k)
        drawn[k] = drawn_vertex(data, draw.node, at.vertex + data.corners[3 * t + k], draw.mask);
      if (is_collapsed(data, drawn)) continue;
      for (const std::uint32_t v : drawn) indices_[to++] = v;
    }
    slot.index_count = to - slot.first_index;
    if (slot.index_count > 0) changed_.push_back({slot.first_index, slot.index_count});
    triangle += range.triangle_count;
  }
  written_[draw.node] = draw.mask;
}

void DrawSlots::add_range(const DrawRange& range, std::uint32_t node) {
  if (range.index_count == 0) return;
  ranges_.push_back(range);
  range_nodes_.push_back(node);
}

void DrawSlots::gather_ranges(std::span<const PatchDraw> draws, bool switches) {
  const PatchTreeData& data = tree_->data();
  const float finest = static_cast<float>(std::max(1u, tree_->finest_level()));
  ranges_.clear();
  range_nodes_.clear();
  for (const PatchDraw& draw : draws) {
    const bool is_switched = switches && draw.mask != 0;
    DrawRange range;
    if (tree_->finest_level() > 0) range.level = static_cast<float>(level_of_[draw.node]) / finest;
    std::uint32_t triangle = data.offsets[draw.node].triangle;
    for (std::uint32_t r = data.offsets[draw.node].range; r < data.offsets[draw.node + 1].range;
         ++r) {
      const PatchRange& part = data.ranges[r];
      range.material = part.material;
      range.first_index = 3 * triangle;
      range.index_count = 3 * (is_switched ? part.constant_triangles : part.triangle_count);
      add_range(range, draw.node);
      if (is_switched) {
        range.first_index = slots_[r].first_index;
        range.index_count = slots_[r].index_count;
        add_range(range, draw.node);
      }
      triangle += part.triangle_count;
    }
  }
}

DrawList DrawSlots::list(std::span<const PatchDraw> draws, bool switches) {
  // What is marked beyond the draws is gone.
  changed_.clear();
  const auto write_new = [&](const PatchDraw& draw) {
    if (draw.mask != 0 && written_[draw.node] != draw.mask) write(draw);
  };
  const bool is_first = ranges_.empty();
  if (is_first)
    for (const PatchDraw& draw : draws) write_new(draw);
  for (const std::uint32_t place : marked_) {
    is_marked_[place] = 0;
    if (place < draws.size()) write_new(draws[place]);
  }
  if (is_first || !marked_.empty() || draws.size() != listed_ || switches != switched_)
    gather_ranges(draws, switches);
  marked_.clear();
  listed_ = draws.size();
  switched_ = switches;

  DrawList list = draw_vertices(tree_->data().vertices);
  list.indices = indices_;
  list.ranges = ranges_;
  list.changed_indices = changed_;
  return list;
}

std::size_t DrawSlots::bytes() const {
  return (indices_.capacity() + written_.capacity() + marked_.capacity() +
          range_nodes_.capacity()) *
             sizeof(std::uint32_t) +
         slots_.capacity() * sizeof(Slot) + level_of_.capacity() + is_marked_.capacity() +
         ranges_.capacity() * sizeof(DrawRange) + changed_.capacity() * sizeof(ElementRange);
}

}  // namespace varifold
