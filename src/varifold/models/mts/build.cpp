#include <varifold/models/mts/build.h>

#include <varifold/models/mts/strip_history.h>
#include <varifold/simplify/sequence_replay.h>
#include <algorithm>
#include <array>
#include <cassert>
#include <span>

namespace varifold {

namespace {

using mts::StripHistory;
using mts::StripItem;

// For each vertex the strips that have it: short lists that only grow.
class StripsOfVertex {
 public:
  explicit StripsOfVertex(std::uint32_t vertices) : first_(vertices, kNone) {}

  void add(std::uint32_t vertex, std::uint32_t strip) {
    for (std::uint32_t e = first_[vertex]; e != kNone; e = entries_[e].next)
      if (entries_[e].strip == strip) return;
    entries_.push_back({strip, first_[vertex]});
    first_[vertex] = static_cast<std::uint32_t>(entries_.size() - 1);
  }
  template <class Visit>
  void for_each(std::uint32_t vertex, const Visit& visit) const {
    for (std::uint32_t e = first_[vertex]; e != kNone; e = entries_[e].next)
      visit(entries_[e].strip);
  }
  void clear(std::uint32_t vertex) { first_[vertex] = kNone; }

 private:
  struct Entry {
    std::uint32_t strip, next;
  };
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> first_;
};

class MtsBuilder {
 public:
  MtsBuilder(const DetailedMesh& detailed, const TriangleStrips& strips, const MtsOptions& options)
      : detailed_(detailed),
        strips_of_(detailed.mesh.vertex_count()),
        replay_(detailed),
        largest_graph_(std::min(options.largest_graph, MultiresolutionStripsData::kStripLimit)) {
    const std::uint32_t finest = detailed.sequence.step_count();
    for (std::uint32_t s = 0; s < strips.count(); ++s)
      add_pieces(strips.strip(s), strips.range[s], options.longest_strip, finest);
  }

  MultiresolutionStrips build() {
    for (std::uint32_t level = detailed_.sequence.step_count(); level-- > 0;) collapse(level);

    MultiresolutionStripsData data;
    data.mesh = detailed_.mesh;
    data.mesh.indices.clear();
    data.mesh.indices.shrink_to_fit();
    data.levels = LevelTable(detailed_.sequence);
    data.strips.emplace_back();
    const std::size_t ranges = std::max<std::size_t>(1, detailed_.mesh.ranges.size());
    for (std::uint32_t r = 0; r < ranges; ++r) {
      data.first_strip.push_back(static_cast<std::uint32_t>(data.strips.size() - 1));
      for (std::size_t s = 0; s < histories_.size(); ++s)
        if (range_[s] == r) histories_[s].append_to(data);
    }
    data.first_strip.push_back(static_cast<std::uint32_t>(data.strips.size() - 1));
    return MultiresolutionStrips(std::move(data));
  }

 private:
  // Cuts at even places, so that every piece begins with the orientation that it has.
  void add_pieces(std::span<const std::uint32_t> strip, std::uint32_t range, std::uint32_t longest,
                  std::uint32_t level) {
    const std::size_t step = std::max(4u, longest) / 2 * 2 - 2;
    for (std::size_t begin = 0; begin + 2 < strip.size(); begin += step) {
      items_.clear();
      for (const std::uint32_t v : strip.subspan(begin, std::min(step + 2, strip.size() - begin)))
        items_.push_back({v, kNone});
      reducer_.reduce(items_);
      add_strip(items_, range, level, level);
    }
  }

  // A strip that has nothing above `level`.
  void add_strip(std::vector<StripItem>& items, std::uint32_t range, std::uint32_t level,
                 std::uint32_t finest) {
    const auto strip = static_cast<std::uint32_t>(histories_.size());
    histories_.emplace_back();
    range_.push_back(range);
    touched_at_.push_back(kNone);
    std::vector<StripItem> nothing;
    if (level < finest) histories_.back().advance(finest, nothing);
    histories_.back().advance(level, items);
    for (const StripItem& item : items)
      if (item.vertex != kStripRestart) strips_of_.add(item.vertex, strip);
  }

  void collapse(std::uint32_t level) {
    const CollapseSequence& sequence = detailed_.sequence;
    const std::uint32_t begin = sequence.vertices[level], end = sequence.vertices[level + 1];
    replay_.collapse();
    touched_.clear();
    for (std::uint32_t v = begin; v < end; ++v) {
      strips_of_.for_each(v, [&](std::uint32_t s) {
        if (touched_at_[s] == level) return;
        touched_at_[s] = level;
        touched_.push_back(s);
      });
    }
    find_leftovers(begin);
    for (const std::uint32_t s : touched_) update(s, level);
    assert(leftovers_.empty());
    for (std::uint32_t v = begin; v < end; ++v) {
      strips_of_.for_each(v, [&](std::uint32_t s) { strips_of_.add(sequence.target[v], s); });
      strips_of_.clear(v);
    }
  }

  // Triangles that go although their corners stay three vertices: two of them at one position.
  void find_leftovers(std::uint32_t live) {
    leftovers_.clear();
    for (const std::uint32_t t : replay_.removed()) {
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = replay_.corners()[3 * std::size_t{t} + k];
        corners[k] = v < live ? v : detailed_.sequence.target[v];
      }
      if (!is_degenerate(corners)) leftovers_.push_back(corners);
    }
  }

  void update(std::uint32_t strip, std::uint32_t level) {
    const std::uint32_t live = detailed_.sequence.vertices[level];
    items_ = histories_[strip].items();
    bool changed = false;
    for (StripItem& item : items_) {
      if (item.vertex == kStripRestart || item.vertex < live) continue;
      item = {detailed_.sequence.target[item.vertex], kNone};
      changed = true;
    }
    if (!changed) return;
    std::erase_if(leftovers_, [&](const auto& c) { return mts::cut_triangle(c, items_); });
    reducer_.reduce(items_);
    if (histories_[strip].has_room(largest_graph_)) {
      histories_[strip].advance(level, items_);
      return;
    }
    std::vector<StripItem> nothing;
    histories_[strip].advance(level, nothing);
    for (StripItem& item : items_) item.node = kNone;
    add_strip(items_, range_[strip], level, detailed_.sequence.step_count());
  }

  const DetailedMesh& detailed_;
  StripsOfVertex strips_of_;
  SequenceReplay replay_;
  std::uint32_t largest_graph_;
  mts::StripReducer reducer_;
  std::vector<StripHistory> histories_;
  std::vector<std::uint32_t> range_;       // per strip
  std::vector<std::uint32_t> touched_at_;  // per strip, the level that touched it last
  std::vector<std::uint32_t> touched_;
  std::vector<std::array<std::uint32_t, 3>> leftovers_;
  std::vector<StripItem> items_;
};

}  // namespace

MultiresolutionStrips build_mts(const DetailedMesh& detailed, const TriangleStrips& full_strips,
                                const MtsOptions& options) {
  assert(!detailed.sequence.moves_vertices());
  return MtsBuilder(detailed, full_strips, options).build();
}

}  // namespace varifold
