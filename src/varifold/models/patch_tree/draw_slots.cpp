#include <varifold/models/patch_tree/draw_slots.h>

#include <varifold/models/patch_tree/extract.h>
#include <algorithm>
#include <utility>

namespace varifold {

DrawSlots::DrawSlots(std::shared_ptr<const PatchTree> tree) : tree_(std::move(tree)) {
  const PatchTreeData& data = tree_->data();
  std::uint32_t most_border = 0;
  for (std::uint32_t node = 0; node < tree_->node_count(); ++node) {
    const PatchOffsets& at = data.offsets[node];
    const PatchOffsets& end = data.offsets[node + 1];
    std::uint32_t border = 0;
    for (std::uint32_t r = at.range; r < end.range; ++r)
      border += data.ranges[r].triangle_count - data.ranges[r].constant_triangles;
    most_border = std::max(most_border, border);
    ranges_per_slot_ = std::max(ranges_per_slot_, 2 * (end.range - at.range));
  }
  first_slot_ = static_cast<std::uint32_t>(data.corners.size());
  slot_indices_ = 3 * most_border;
  // No front has more patches than there are leaves. What is not used costs addresses alone, and
  // the triangles of all patches need not move when a front grows.
  const PatchTopology& t = data.topology;
  most_slots_ = t.level_count() == 0 ? 0 : t.node_count() - t.first_of_level[t.level_count() - 1];
  indices_.reserve(first_slot_ + most_slots_ * slot_indices_);
  slot_ranges_.reserve(most_slots_ * ranges_per_slot_);
  for (std::uint32_t node = 0; node < tree_->node_count(); ++node) {
    const PatchOffsets& at = data.offsets[node];
    for (std::size_t i = 3 * std::size_t{at.triangle};
         i < 3 * std::size_t{data.offsets[node + 1].triangle}; ++i)
      indices_.push_back(at.vertex + data.corners[i]);
  }
}

void DrawSlots::mark(std::span<const std::uint32_t> slots) {
  for (const std::uint32_t slot : slots) {
    if (slot >= is_marked_.size()) is_marked_.resize(slot + std::size_t{1}, 0);
    if (is_marked_[slot] == 0) marked_.push_back(slot);
    is_marked_[slot] = 1;
  }
}

void DrawSlots::make_room(std::size_t slots) {
  if (slots <= room_) return;
  room_ = std::min(most_slots_, slots + slots / 2);
  indices_.resize(first_slot_ + room_ * slot_indices_);
  slot_ranges_.resize(room_ * ranges_per_slot_);
  range_counts_.resize(room_, 0);
  is_marked_.resize(std::max(is_marked_.size(), room_), 0);
  ranges_.reserve(slot_ranges_.size());
  range_nodes_.reserve(slot_ranges_.size());
  changed_.reserve(room_);
  marked_.reserve(room_);
}

void DrawSlots::add_range(std::uint32_t slot, const DrawRange& range) {
  if (range.index_count == 0) return;
  slot_ranges_[slot * std::size_t{ranges_per_slot_} + range_counts_[slot]++] = range;
}

// Returns where it ends.
std::uint32_t DrawSlots::write_border(std::uint32_t node, std::uint32_t mask,
                                      std::size_t first_triangle, std::size_t end_triangle,
                                      std::uint32_t to) {
  const PatchTreeData& data = tree_->data();
  const std::uint32_t first_vertex = data.offsets[node].vertex;
  for (std::size_t t = first_triangle; t < end_triangle; ++t) {
    std::uint32_t drawn[3];
    for (std::size_t k = 0; k < 3; ++k)
      drawn[k] = drawn_vertex(data, node, first_vertex + data.corners[3 * t + k], mask);
    if (is_collapsed(data, drawn)) continue;
    for (const std::uint32_t v : drawn) indices_[to++] = v;
  }
  return to;
}

void DrawSlots::write(std::uint32_t slot, const PatchDraw& draw) {
  const PatchTreeData& data = tree_->data();
  const PatchOffsets& at = data.offsets[draw.node];
  range_counts_[slot] = 0;
  DrawRange range;
  const std::uint32_t finest = tree_->finest_level();
  if (finest > 0)
    range.level = static_cast<float>(tree_->level_of(draw.node)) / static_cast<float>(finest);
  std::uint32_t to = first_slot_ + slot * slot_indices_;
  std::uint32_t triangle = at.triangle;
  for (std::uint32_t r = at.range; r < data.offsets[draw.node + 1].range; ++r) {
    const PatchRange& part = data.ranges[r];
    range.material = part.material;
    range.first_index = 3 * triangle;
    range.index_count = 3 * (draw.mask == 0 ? part.triangle_count : part.constant_triangles);
    add_range(slot, range);
    if (draw.mask != 0) {
      const std::uint32_t end =
          write_border(draw.node, draw.mask, triangle + std::size_t{part.constant_triangles},
                       triangle + std::size_t{part.triangle_count}, to);
      range.first_index = to;
      range.index_count = end - to;
      add_range(slot, range);
      to = end;
    }
    triangle += part.triangle_count;
  }
}

void DrawSlots::gather_ranges(std::span<const PatchDraw> draws) {
  ranges_.clear();
  range_nodes_.clear();
  for (std::size_t slot = 0; slot < draws.size(); ++slot) {
    const DrawRange* first = slot_ranges_.data() + slot * ranges_per_slot_;
    ranges_.insert(ranges_.end(), first, first + range_counts_[slot]);
    range_nodes_.insert(range_nodes_.end(), range_counts_[slot], draws[slot].node);
  }
}

DrawList DrawSlots::list(std::span<const PatchDraw> draws, bool switches) {
  make_room(draws.size());
  if (all_are_new_) {
    marked_.clear();
    for (std::uint32_t slot = 0; slot < draws.size(); ++slot) marked_.push_back(slot);
  }
  std::sort(marked_.begin(), marked_.end());
  changed_.clear();
  for (const std::uint32_t slot : marked_) {
    is_marked_[slot] = 0;
    if (slot >= draws.size()) continue;
    const PatchDraw draw{draws[slot].node, switches ? draws[slot].mask : 0};
    write(slot, draw);
    const std::uint32_t first = first_slot_ + slot * slot_indices_;
    if (draw.mask == 0) continue;
    if (!changed_.empty() && changed_.back().first + changed_.back().count == first)
      changed_.back().count += slot_indices_;
    else
      changed_.push_back({first, slot_indices_});
  }
  if (!marked_.empty() || all_are_new_ || draws.size() != listed_) gather_ranges(draws);
  listed_ = draws.size();
  if (all_are_new_) std::fill(is_marked_.begin(), is_marked_.end(), std::uint8_t{0});
  all_are_new_ = false;
  marked_.clear();

  const TriangleMesh& vertices = tree_->data().vertices;
  DrawList list;
  list.positions = vertices.positions;
  list.normals = vertices.normals;
  list.texcoords = vertices.texcoords;
  list.colors = vertices.colors;
  list.indices = indices_;
  list.ranges = ranges_;
  list.changed_indices = changed_;
  return list;
}

std::size_t DrawSlots::bytes() const {
  return (indices_.size() + range_counts_.capacity() + marked_.capacity() +
          range_nodes_.capacity()) *
             sizeof(std::uint32_t) +
         (slot_ranges_.size() + ranges_.capacity()) * sizeof(DrawRange) + is_marked_.capacity() +
         changed_.capacity() * sizeof(ElementRange);
}

}  // namespace varifold
