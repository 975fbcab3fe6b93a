#include <varifold/models/pm/split_record.h>

#include <algorithm>

namespace varifold::pm {

void SplitRecord::clear() {
  wedges.clear();
  moved.clear();
  triangles.clear();
  codes.clear();
  placed_vertices.clear();
  placed_codes.clear();
  lessons.clear();
  error_drop = 0;
}

void SplitSurface::reserve(std::size_t vertices, std::size_t triangles) {
  corners_.reserve(3 * triangles);
  next_.reserve(3 * triangles);
  first_.reserve(vertices);
  last_.reserve(vertices);
}

void SplitSurface::add_block(std::uint32_t range, std::uint32_t capacity) {
  const auto first = static_cast<std::uint32_t>(corners_.size() / 3);
  std::vector<Block>& blocks = blocks_[range];
  if (!blocks.empty() && blocks.back().first + blocks.back().capacity == first)
    blocks.back().capacity += capacity;
  else
    blocks.push_back({first, 0, capacity});
  const std::size_t triangles = std::size_t{first} + capacity;
  corners_.resize(3 * triangles, 0);
  next_.resize(3 * triangles, kNone);
  if (blocks_.size() > 1) range_of_triangle_.resize(triangles, range);
}

void SplitSurface::add_vertices(std::uint32_t count) {
  first_.resize(first_.size() + count, kNone);
  last_.resize(last_.size() + count, kNone);
}

std::uint32_t SplitSurface::add_triangle(const NewTriangle& triangle) {
  std::vector<Block>& blocks = blocks_[triangle.range];
  if (blocks.empty() || blocks.back().count == blocks.back().capacity) {
    std::uint32_t present = 0;
    for (const Block& block : blocks) present += block.count;
    // One range alone grows in place; several double, so that each has few blocks.
    add_block(triangle.range, blocks_.size() == 1 ? 1 : std::max(64u, present));
  }
  Block& block = blocks.back();
  const std::uint32_t id = block.first + block.count++;
  for (std::uint32_t c = 0; c < 3; ++c) append_slot(triangle.corners[c], 3 * id + c);
  ++triangle_count_;
  return id;
}

void SplitSurface::append_slot(std::uint32_t vertex, std::uint32_t slot) {
  corners_[slot] = vertex;
  next_[slot] = kNone;
  if (first_[vertex] == kNone)
    first_[vertex] = slot;
  else
    next_[last_[vertex]] = slot;
  last_[vertex] = slot;
}

void SplitSurface::free_slots(const SplitRecord& record, std::uint32_t vertex,
                              std::vector<std::uint32_t>& slots) const {
  const std::size_t begin = slots.size();
  for (std::uint32_t slot = first_[vertex]; slot != kNone; slot = next_[slot])
    slots.push_back(slot);
  for (const SplitWedge& wedge : record.wedges) {
    if (wedge.target != vertex) continue;
    // What an earlier wedge takes stands in the same order as the list.
    std::uint32_t taken = wedge.first_moved;
    std::size_t kept = begin;
    for (std::size_t i = begin; i < slots.size(); ++i) {
      if (taken < wedge.end_moved && slots[i] == record.moved[taken])
        ++taken;
      else
        slots[kept++] = slots[i];
    }
    slots.resize(kept);
  }
}

bool SplitSurface::predict_triangles(const SplitRecord& record, const SplitWedge& wedge,
                                     std::uint32_t vertex,
                                     std::vector<NewTriangle>& triangles) const {
  const std::uint32_t* moved = record.moved.data() + wedge.first_moved;
  const std::uint32_t count = wedge.end_moved - wedge.first_moved;
  if (!wedge.leads && !wedge.closes) return true;
  if (count == 0 || count > kMaxFan) return false;

  // The first spoke begins a triangle and ends none; the last one ends a triangle only.
  std::array<std::uint32_t, kMaxFan> starts, ends;
  for (std::uint32_t i = 0; i < count; ++i) {
    starts[i] = corner_after(moved[i]);
    ends[i] = corner_before(moved[i]);
  }
  const auto lone = [&](const auto& these, const auto& those) {
    for (std::uint32_t i = 0; i < count; ++i)
      if (std::find(those.begin(), those.begin() + count, these[i]) == those.begin() + count)
        return i;
    return kNone;
  };
  if (wedge.leads) {
    const std::uint32_t i = lone(starts, ends);
    if (i == kNone) return false;
    triangles.push_back({{vertex, wedge.target, starts[i]}, range_of(moved[i] / 3)});
  }
  if (wedge.closes) {
    const std::uint32_t i = lone(ends, starts);
    if (i == kNone) return false;
    triangles.push_back({{vertex, ends[i], wedge.target}, range_of(moved[i] / 3)});
  }
  return true;
}

void SplitSurface::ring_of(const SplitRecord& record, std::uint32_t wedge_index,
                           std::vector<std::uint32_t>& ring) const {
  const SplitWedge& wedge = record.wedges[wedge_index];
  for (std::uint32_t i = wedge.first_moved; i < wedge.end_moved; ++i) {
    ring.push_back(corner_after(record.moved[i]));
    ring.push_back(corner_before(record.moved[i]));
  }
  const std::uint32_t vertex = vertex_count() + wedge_index;
  for (const NewTriangle& triangle : record.triangles) {
    const auto& corners = triangle.corners;
    if (std::find(corners.begin(), corners.end(), vertex) == corners.end()) continue;
    for (const std::uint32_t corner : corners)
      if (corner < vertex_count()) ring.push_back(corner);
  }
}

void SplitSurface::move_slots(const SplitRecord& record, const SplitWedge& wedge,
                              std::uint32_t vertex) {
  std::uint32_t moved = wedge.first_moved;
  std::uint32_t last_kept = kNone;
  const std::uint32_t target = wedge.target;
  for (std::uint32_t slot = first_[target]; slot != kNone && moved < wedge.end_moved;) {
    const std::uint32_t next = next_[slot];
    if (slot != record.moved[moved]) {
      last_kept = slot;
    } else {
      ++moved;
      if (last_kept == kNone)
        first_[target] = next;
      else
        next_[last_kept] = next;
      if (last_[target] == slot) last_[target] = last_kept;
      append_slot(vertex, slot);
    }
    slot = next;
  }
}

void SplitSurface::apply(const SplitRecord& record) {
  const std::uint32_t old_count = vertex_count();
  const auto wedges = static_cast<std::uint32_t>(record.wedges.size());
  add_vertices(wedges);
  for (std::uint32_t i = 0; i < wedges; ++i) move_slots(record, record.wedges[i], old_count + i);
  added_.clear();
  for (const NewTriangle& triangle : record.triangles) added_.push_back(add_triangle(triangle));
}

Prediction predict_vertex(const StreamState& state, const SplitRecord& record,
                          std::uint32_t wedge_index, std::vector<std::uint32_t>& ring) {
  const AttributeCoder& coder = state.coder;
  const SplitSurface& surface = state.surface;
  Prediction prediction;
  const std::uint32_t target = record.wedges[wedge_index].target;
  ring.clear();
  if (wedge_index > 0) {
    prediction = coder.predict_next(record.codes[0]);
  } else {  // the place of a point depends on the triangles of all its wedges
    for (std::uint32_t i = 0; i < record.wedges.size(); ++i) surface.ring_of(record, i, ring);
    coder.predict_mean(Field::kPosition, ring, target, state.table, prediction);
  }
  if (record.wedges.size() > 1) {
    ring.clear();
    surface.ring_of(record, wedge_index, ring);
  }
  for (const Field field : {Field::kNormal, Field::kTexcoord, Field::kColor})
    coder.predict_mean(field, ring, target, state.table, prediction);
  return prediction;
}

void predict_placed_vertices(const SplitRecord& record, std::vector<std::uint32_t>& vertices) {
  vertices.clear();
  for (const SplitWedge& wedge : record.wedges)
    if (std::find(vertices.begin(), vertices.end(), wedge.target) == vertices.end())
      vertices.push_back(wedge.target);
}

void StreamState::apply(const SplitRecord& record) {
  surface.apply(record);
  const std::uint32_t channels = coder.channel_count();
  for (const Codes& codes : record.codes)
    table.insert(table.end(), codes.begin(), codes.begin() + channels);
  for (std::size_t i = 0; i < record.placed_vertices.size(); ++i)
    std::copy_n(record.placed_codes[i].begin(), channels,
                table.begin() + std::ptrdiff_t{record.placed_vertices[i]} * channels);
  error -= record.error_drop;
  for (const SplitRecord::Lesson& lesson : record.lessons)
    models.model[lesson.model].update(lesson.value);
}

Codes StreamState::codes_of(std::uint32_t vertex) const {
  Codes codes{};
  const std::uint32_t channels = coder.channel_count();
  std::copy_n(table.begin() + std::ptrdiff_t{vertex} * channels, channels, codes.begin());
  return codes;
}

std::uint32_t split_off(const SplitRecord& record, std::uint32_t vertex) {
  for (std::uint32_t i = 0; i < record.wedges.size(); ++i)
    if (record.wedges[i].target == vertex) return i;
  return 0;
}

}  // namespace varifold::pm
