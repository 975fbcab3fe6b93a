#include <varifold/strip/sequence_strips.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace varifold {

SequenceStrips::SequenceStrips(const DetailedMesh& detailed, const SequenceHistory& history,
                               FirstCorners first)
    : sequence_(detailed.sequence),
      history_(history),
      corners_(history.first_corners()),
      first_(std::move(first)) {
  const std::uint32_t triangles = detailed.mesh.triangle_count();
  if (first_.empty()) first_.assign(triangles, kAnyCorner);
  learned_ = first_;
  neighbor_.assign(corners_.size(), kNone);
  block_of_.assign(triangles, kNone);
  if (detailed.mesh.ranges.size() > 1) {
    range_of_.resize(triangles);
    for (std::uint32_t r = 0; r < detailed.mesh.ranges.size(); ++r) {
      const MaterialRange& range = detailed.mesh.ranges[r];
      std::fill_n(range_of_.begin() + range.first_triangle, range.triangle_count, r);
    }
  }
  last_block_.assign(std::max<std::size_t>(1, detailed.mesh.ranges.size()), kNone);
  load_base(detailed);
}

// True where the two edges are one edge of the surface: the same vertices, opposite directions, one
// material.
bool SequenceStrips::matches(Edge a, Edge b) const {
  return corner(a) == corner({b.triangle, b.edge + 1}) &&
         corner(b) == corner({a.triangle, a.edge + 1}) &&
         (range_of_.empty() || range_of_[a.triangle] == range_of_[b.triangle]);
}

SequenceStrips::Edge SequenceStrips::across(Edge edge) const {
  const std::uint32_t t = neighbor_[3 * edge.triangle + edge.edge];
  for (std::uint32_t e = 0; e < 3; ++e)
    if (neighbor_[3 * t + e] == edge.triangle && matches(edge, {t, e})) return {t, e};
  return {kNone, 0};
}

void SequenceStrips::split() {
  changes_.clear();
  gather_corners();
  update_links();
  for (const std::uint32_t t : history_.added(level_)) unplaced_.push_back(t);
  std::sort(moved_.begin(), moved_.end(), [](const Corner& a, const Corner& b) {
    return a.block != b.block ? a.block < b.block : a.triangle < b.triangle;
  });
  for (std::size_t i = 0, end = 0; i < moved_.size(); i = end) {
    for (end = i + 1; end < moved_.size() && moved_[end].block == moved_[i].block;) ++end;
    change_block(moved_[i].block, std::span(moved_).subspan(i, end - i));
  }
  place_new_triangles();
  ++level_;
}

void SequenceStrips::gather_corners() {
  moved_.clear();
  for (std::uint32_t v = sequence_.vertices[level_]; v < sequence_.vertices[level_ + 1]; ++v) {
    for (const std::uint32_t slot : history_.changed(v)) {
      corners_[slot] = v;
      moved_.push_back({block_of_[slot / 3], slot / 3, slot % 3, v});
    }
  }
}

// The new triangles come between old neighbours.
void SequenceStrips::update_links() {
  open_.clear();
  const auto open = [&](Edge edge) {
    neighbor_[3 * edge.triangle + edge.edge] = kNone;
    open_.push_back(edge);
  };
  for (const Corner& moved : moved_) {
    for (const Edge edge :
         {Edge{moved.triangle, moved.corner}, Edge{moved.triangle, (moved.corner + 2) % 3}}) {
      const std::uint32_t other = neighbor_[3 * edge.triangle + edge.edge];
      if (other != kNone && across(edge).triangle != kNone) continue;
      open(edge);
      if (other == kNone) continue;
      for (std::uint32_t e = 0; e < 3; ++e)
        if (neighbor_[3 * other + e] == edge.triangle && across({other, e}).triangle == kNone)
          open({other, e});
    }
  }
  for (const std::uint32_t t : history_.added(level_))
    for (std::uint32_t e = 0; e < 3; ++e) open({t, e});
  link_open_edges();
}

void SequenceStrips::link_open_edges() {
  for (std::size_t i = 0; i < open_.size(); ++i) {
    std::size_t found = open_.size();
    for (std::size_t j = 0; j < open_.size(); ++j) {
      if (!matches(open_[i], open_[j])) continue;
      found = found == open_.size() ? j : open_.size() + 1;
      if (found > open_.size()) break;
    }
    if (found < open_.size())
      neighbor_[3 * open_[i].triangle + open_[i].edge] = open_[found].triangle;
  }
  // Links that only one side has found are of edges with more than two triangles.
  for (const Edge& edge : open_) {
    const std::uint32_t other = neighbor_[3 * edge.triangle + edge.edge];
    if (other == kNone) continue;
    bool mutual = false;
    for (std::uint32_t e = 0; e < 3; ++e)
      mutual |= neighbor_[3 * other + e] == edge.triangle && matches(edge, {other, e});
    if (!mutual) neighbor_[3 * edge.triangle + edge.edge] = kNone;
  }
}

TriangleStrips SequenceStrips::strips() const {
  TriangleStrips strips;
  for (const Block& block : blocks_) {
    for (std::uint32_t begin = 0; begin < block.count;) {
      const std::uint32_t end = strip_end(block, begin);
      strips.indices.insert(strips.indices.end(), block.slots + begin, block.slots + end);
      strips.end_strip(block.range);
      begin = end + 1;
    }
  }
  return strips;
}

TriangleStrips stripify_along_sequence(const DetailedMesh& detailed) {
  const SequenceHistory history(detailed);
  SequenceStrips strips(detailed, history);
  while (strips.level() < detailed.sequence.step_count()) strips.split();
  return strips.strips();
}

}  // namespace varifold
