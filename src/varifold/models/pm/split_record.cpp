#include <varifold/models/pm/split_record.h>

#include <algorithm>
#include <bit>

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
  slots_.reserve(vertices);
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
  if (blocks_.size() > 1) range_of_triangle_.resize(triangles, range);
}

std::uint32_t SplitSurface::add_triangle(const NewTriangle& triangle) {
  std::vector<Block>& blocks = blocks_[triangle.range];
  if (blocks.empty() || blocks.back().count == blocks.back().capacity) {
    // Doubled, so that each range has few blocks.
    std::uint32_t present = 0;
    for (const Block& block : blocks) present += block.count;
    add_block(triangle.range, std::max(64u, present));
  }
  Block& block = blocks.back();
  const std::uint32_t id = block.first + block.count++;
  for (std::uint32_t c = 0; c < 3; ++c) {
    corners_[3 * id + c] = triangle.corners[c];
    slots_.append(triangle.corners[c], 3 * id + c);
  }
  ++triangle_count_;
  return id;
}

std::span<const std::uint32_t> SplitSurface::free_slots(const SplitRecord& record,
                                                        std::uint32_t vertex,
                                                        std::vector<std::uint32_t>& scratch) const {
  std::span<const std::uint32_t> free = slots_.list(vertex);
  for (const SplitWedge& wedge : record.wedges) {
    if (wedge.target != vertex) continue;
    // What an earlier wedge takes stands in the same order as the list.
    scratch.assign(free.begin(), free.end());
    std::uint32_t taken = wedge.first_moved;
    std::size_t kept = 0;
    for (const std::uint32_t slot : scratch) {
      if (taken < wedge.end_moved && slot == record.moved[taken])
        ++taken;
      else
        scratch[kept++] = slot;
    }
    scratch.resize(kept);
    free = scratch;
  }
  return free;
}

bool SplitSurface::predict_triangles(const SplitRecord& record, const SplitWedge& wedge,
                                     std::uint32_t vertex,
                                     std::vector<NewTriangle>& triangles) const {
  const std::uint32_t* moved = record.moved.data() + wedge.first_moved;
  const std::uint32_t count = wedge.end_moved - wedge.first_moved;
  if (!wedge.leads && !wedge.closes) return true;
  if (count == 0 || count > kMaxFan) return false;

  // The first spoke begins a triangle and ends none; the last one ends a triangle only. Fans are
  // short: each pair is looked at, without branches.
  std::array<std::uint32_t, kMaxFan> ends;
  for (std::uint32_t i = 0; i < count; ++i) ends[i] = corner_before(moved[i]);
  std::uint64_t lone_starts = 0, met_ends = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t start = corner_after(moved[i]);
    std::uint64_t met = 0;
    for (std::uint32_t j = 0; j < count; ++j)
      met |= static_cast<std::uint64_t>(ends[j] == start) << j;
    lone_starts |= static_cast<std::uint64_t>(met == 0) << i;
    met_ends |= met;
  }
  if (wedge.leads) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(lone_starts));
    if (i >= count) return false;
    const std::uint32_t start = corner_after(moved[i]);
    slots_.prefetch(start);
    triangles.push_back({{vertex, wedge.target, start}, range_of(moved[i] / 3)});
  }
  if (wedge.closes) {
    const auto i = static_cast<std::uint32_t>(std::countr_one(met_ends));
    if (i >= count) return false;
    slots_.prefetch(ends[i]);
    triangles.push_back({{vertex, ends[i], wedge.target}, range_of(moved[i] / 3)});
  }
  return true;
}

void SplitSurface::ring_of(const SplitRecord& record, std::uint32_t wedge_index,
                           std::vector<std::uint32_t>& ring) const {
  const SplitWedge& wedge = record.wedges[wedge_index];
  for (std::uint32_t i = wedge.first_moved; i < wedge.end_moved; ++i)
    ring.push_back(corner_after(record.moved[i]));
  const std::uint32_t vertex = vertex_count() + wedge_index;
  for (const NewTriangle& triangle : record.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (triangle.corners[c] != vertex) continue;
      const std::uint32_t next = triangle.corners[c == 2 ? 0 : c + 1];
      if (next < vertex_count()) ring.push_back(next);
    }
  }
}

void SplitSurface::apply(const SplitRecord& record) {
  std::uint32_t vertex = vertex_count();
  add_vertices(static_cast<std::uint32_t>(record.wedges.size()));
  for (const SplitWedge& wedge : record.wedges) {
    const std::span<const std::uint32_t> moved(record.moved.data() + wedge.first_moved,
                                               record.moved.data() + wedge.end_moved);
    slots_.move(wedge.target, moved, vertex);
    for (const std::uint32_t slot : moved) corners_[slot] = vertex;
    ++vertex;
  }
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
