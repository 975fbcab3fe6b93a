#include <varifold/models/pm/instance.h>

#include <varifold/mesh/vertex_arrays.h>
#include <varifold/models/common/extract_level.h>
#include <varifold/view/draw_vertices.h>
#include <algorithm>
#include <cassert>

namespace varifold {

namespace {

constexpr std::uint32_t kLastSlot = ProgressiveMeshData::kLastSlot;
constexpr std::uint32_t kNoSlot = ProgressiveMeshData::kNoSlot;

template <class T>
void copy_one(const std::vector<T>& from, std::uint32_t index, std::vector<T>& to,
              std::uint32_t vertex) {
  if (!from.empty()) to[vertex] = from[index];
}

}  // namespace

ProgressiveMeshInstance::ProgressiveMeshInstance(std::shared_ptr<const ProgressiveMesh> model)
    : model_(std::move(model)) {
  const ProgressiveMeshData& data = model_->data();
  indices_ = data.mesh.indices;
  vertex_count_ = data.base_vertices;
  triangle_count_ = data.base_triangles;
  changed_indices_.reset(indices_.size());
  changed_vertices_.reset(data.mesh.positions.size());

  const std::size_t ranges = std::max<std::size_t>(1, data.mesh.ranges.size());
  range_counts_.assign(ranges, 0);
  ranges_.reserve(ranges);
  for (std::size_t r = 0; r < data.mesh.ranges.size() && !data.triangle_level.empty(); ++r) {
    const MaterialRange& range = data.mesh.ranges[r];
    const auto first = data.triangle_level.begin() + range.first_triangle;
    range_counts_[r] = static_cast<std::uint32_t>(
        std::upper_bound(first, first + range.triangle_count, 0u) - first);
  }
  if (model_->moves_vertices()) {
    moved_.positions = data.mesh.positions;
    moved_.normals = data.mesh.normals;
    moved_.texcoords = data.mesh.texcoords;
    moved_.colors = data.mesh.colors;
    // Level k has what the collapse to k or the last one before it set: go down to level 0.
    for (auto j = static_cast<std::uint32_t>(data.placed_vertex.size()); j-- > 0;)
      place(data.placed_vertex[j], data.placed, j);
  }
}

void ProgressiveMeshInstance::place(std::uint32_t vertex, const TriangleMesh& from,
                                    std::uint32_t index) {
  copy_one(from.positions, index, moved_.positions, vertex);
  copy_one(from.normals, index, moved_.normals, vertex);
  copy_one(from.texcoords, index, moved_.texcoords, vertex);
  copy_one(from.colors, index, moved_.colors, vertex);
  changed_vertices_.mark(vertex);
}

void ProgressiveMeshInstance::go_to_level(std::uint32_t level) {
  level = std::min(level, model_->finest_level());
  if (level > level_)
    split_to(level);
  else
    collapse_to(level);
  level_ = level;
  update_ranges();
}

// The slots of a split, whose first new vertex is `vertex`, get what `value` says of each vertex.
template <class Value>
inline void ProgressiveMeshInstance::set_slots(const std::uint32_t* slots, VertexSplit split,
                                               std::uint32_t vertex, const Value& value) {
  std::uint32_t* const indices = indices_.data();
  if (split.vertices == 1) {
    const std::uint32_t common = value(vertex);
    for (std::uint32_t i = 0; i < split.slots; ++i) {
      const std::uint32_t place = slots[i] & ~kLastSlot;
      indices[place] = common;
      changed_indices_.mark(place);
    }
    return;
  }
  for (std::uint32_t i = 0; i < split.slots; ++i) {
    const std::uint32_t place = slots[i] & ~kLastSlot;
    if (place != kNoSlot) {
      indices[place] = value(vertex);
      changed_indices_.mark(place);
    }
    if (slots[i] & kLastSlot) ++vertex;
  }
}

void ProgressiveMeshInstance::split_to(std::uint32_t level) {
  const ProgressiveMeshData& data = model_->data();
  const std::uint32_t* slot = data.slots.data() + slot_cursor_;
  for (std::uint32_t k = level_; k < level; ++k) {
    const VertexSplit split = data.splits[k];
    set_slots(slot, split, vertex_count_, [](std::uint32_t vertex) { return vertex; });
    slot += split.slots;
    vertex_count_ += split.vertices;
    triangle_count_ += split.triangles;
    if (data.first_placed.empty()) continue;
    for (std::uint32_t j = data.first_placed[k]; j < data.first_placed[k + 1]; ++j) {
      const bool full = data.finer[j] == kNone;
      place(data.placed_vertex[j], full ? data.mesh : data.placed,
            full ? data.placed_vertex[j] : data.finer[j]);
    }
  }
  slot_cursor_ = static_cast<std::uint32_t>(slot - data.slots.data());
}

void ProgressiveMeshInstance::collapse_to(std::uint32_t level) {
  const ProgressiveMeshData& data = model_->data();
  const std::uint32_t* slot = data.slots.data() + slot_cursor_;
  for (std::uint32_t k = level_; k-- > level;) {
    const VertexSplit split = data.splits[k];
    slot -= split.slots;
    vertex_count_ -= split.vertices;
    triangle_count_ -= split.triangles;
    set_slots(slot, split, vertex_count_,
              [&](std::uint32_t vertex) { return data.target[vertex]; });
    if (data.first_placed.empty()) continue;
    for (std::uint32_t j = data.first_placed[k]; j < data.first_placed[k + 1]; ++j)
      place(data.placed_vertex[j], data.placed, j);
  }
  slot_cursor_ = static_cast<std::uint32_t>(slot - data.slots.data());
}

void ProgressiveMeshInstance::update_ranges() {
  const ProgressiveMeshData& data = model_->data();
  if (data.triangle_level.empty()) return;
  for (std::size_t r = 0; r < data.mesh.ranges.size(); ++r) {
    const MaterialRange& range = data.mesh.ranges[r];
    const auto first = data.triangle_level.begin() + range.first_triangle;
    range_counts_[r] = static_cast<std::uint32_t>(
        std::upper_bound(first, first + range.triangle_count, level_) - first);
  }
}

void ProgressiveMeshInstance::append_ranges(std::vector<DrawRange>& ranges) const {
  const TriangleMesh& mesh = model_->data().mesh;
  const std::uint32_t finest = model_->finest_level();
  const float fraction = finest > 0 ? static_cast<float>(level_) / static_cast<float>(finest) : 1;
  if (model_->data().triangle_level.empty()) {
    const std::uint32_t material = mesh.ranges.empty() ? 0 : mesh.ranges[0].material;
    ranges.push_back({0, 3 * triangle_count_, Primitive::kTriangles, material, fraction});
    return;
  }
  for (std::size_t r = 0; r < mesh.ranges.size(); ++r)
    ranges.push_back({3 * mesh.ranges[r].first_triangle, 3 * range_counts_[r],
                      Primitive::kTriangles, mesh.ranges[r].material, fraction});
}

DrawList ProgressiveMeshInstance::draw_list() {
  ranges_.clear();
  append_ranges(ranges_);
  DrawList list = draw_vertices(vertices());
  list.indices = indices_;
  list.ranges = ranges_;
  list.changed_indices = changed_indices_.take();
  list.changed_vertices = changed_vertices_.take();
  return list;
}

std::size_t ProgressiveMeshInstance::bytes() const {
  return (indices_.size() + range_counts_.size()) * sizeof(std::uint32_t) + vertex_bytes(moved_) +
         ranges_.capacity() * sizeof(DrawRange) + changed_indices_.bytes() +
         changed_vertices_.bytes();
}

TriangleMesh ProgressiveMeshInstance::extract() const {
  std::vector<DrawRange> ranges;
  append_ranges(ranges);
  DrawList list = draw_vertices(vertices());
  list.indices = indices_;
  list.ranges = ranges;
  return extract_level(model_->attributes(), vertex_count_, list);
}

}  // namespace varifold
