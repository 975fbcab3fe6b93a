// Based on: [Ramos2008] section 4.2.2 (changes of all levels found in advance; repeated vertices
//   removed).
// Differs: only pairs of indices go, as an odd number would turn the rest of the strip inside out
//   (but for the last index of a strip, behind which nothing stands); and not by two patterns, but
//   wherever the strip without the pair draws the same triangles. That takes in runs (aaaa -> aa),
//   alternations (abab -> ab), aabaa -> aaa and both ends of a strip.
#include <varifold/models/lodstrips/static_removal.h>

#include <varifold/simplify/sequence_replay.h>
#include <algorithm>
#include <array>
#include <utility>

namespace varifold {

namespace {

using Corners = std::array<std::uint32_t, 3>;

// Corners in their order from the least one on.
Corners rotated(Corners c) {
  std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
  return c;
}

// A triangle of the full mesh whose corners are still different when it vanishes.
struct SeamTriangle {
  Corners corners;
  std::uint32_t level;  // the coarsest that has it
  friend bool operator<(const SeamTriangle& a, const SeamTriangle& b) {
    return a.corners != b.corners ? a.corners < b.corners : a.level < b.level;
  }
};

std::vector<SeamTriangle> seam_triangles(const DetailedMesh& detailed) {
  std::vector<SeamTriangle> found;
  const CollapseSequence& sequence = detailed.sequence;
  SequenceReplay replay(detailed);
  while (replay.level() > 0) {
    replay.collapse();
    for (const std::uint32_t t : replay.removed()) {
      Corners now{}, full{};
      for (std::uint32_t c = 0; c < 3; ++c) {
        full[c] = detailed.mesh.indices[3 * t + c];
        now[c] = replay.corners()[3 * t + c];
        if (now[c] >= sequence.vertices[replay.level()]) now[c] = sequence.target[now[c]];
      }
      if (!is_degenerate(now)) found.push_back({rotated(full), replay.level() + 1});
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

// Appends strips to `cut`, cutting them.
class StripCutter {
 public:
  StripCutter(std::vector<SeamTriangle> apart, std::uint32_t max_indices, TriangleStrips& cut)
      : apart_(std::move(apart)), max_indices_(max_indices), cut_(cut) {}

  void add(std::span<const std::uint32_t> strip, std::uint32_t range) {
    for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
      const Corners corners = strip_triangle(strip, i);
      const bool apart = is_apart(corners);
      if (apart || length() == max_indices_) close(range);
      if (apart) {
        cut_.indices.insert(cut_.indices.end(), corners.begin(), corners.end());
        close(range);
      } else if (length() > 0) {
        cut_.indices.push_back(strip[i + 2]);
      } else if (!is_degenerate(corners)) {
        // An odd triangle stays at an odd place.
        if (i % 2 == 1) cut_.indices.push_back(strip[i]);
        cut_.indices.insert(cut_.indices.end(), {strip[i], strip[i + 1], strip[i + 2]});
      }
    }
    close(range);
  }

 private:
  [[nodiscard]] std::size_t length() const { return cut_.indices.size() - cut_.first.back(); }
  [[nodiscard]] bool is_apart(const Corners& corners) const {
    if (apart_.empty() || is_degenerate(corners)) return false;
    const auto found =
        std::lower_bound(apart_.begin(), apart_.end(), SeamTriangle{rotated(corners), 0});
    return found != apart_.end() && found->corners == rotated(corners);
  }
  // Ends the present strip, if any, without the swaps that it ends with.
  void close(std::uint32_t range) {
    if (length() == 0) return;
    const std::span<const std::uint32_t> strip(cut_.indices.data() + cut_.first.back(), length());
    std::size_t end = strip.size();
    while (is_degenerate(strip_triangle(strip, end - 3))) --end;
    cut_.indices.resize(cut_.first.back() + end);
    cut_.end_strip(range);
  }

  std::vector<SeamTriangle> apart_;
  std::uint32_t max_indices_;
  TriangleStrips& cut_;
};

// The triangles with three different corners near a pair: before at most four, two of interest.
// `at(i)` is slot i.
template <class Slot>
struct Window {
  std::array<Corners, 4> triangles;
  std::size_t count = 0;
  void add(const Slot& at, std::uint32_t i) {
    const Corners corners =
        i % 2 == 0 ? Corners{at(i), at(i + 1), at(i + 2)} : Corners{at(i + 1), at(i), at(i + 2)};
    if (!is_degenerate(corners)) triangles[count++] = rotated(corners);
  }
  void sort_two() {
    if (count == 2 && triangles[1] < triangles[0]) std::swap(triangles[0], triangles[1]);
  }
};

}  // namespace

TriangleStrips cut_for_removal(const DetailedMesh& detailed, const TriangleStrips& strips,
                               std::uint32_t max_indices) {
  TriangleStrips cut;
  cut.indices.reserve(strips.indices.size());
  StripCutter cutter(seam_triangles(detailed), max_indices, cut);
  for (std::uint32_t s = 0; s < strips.count(); ++s) cutter.add(strips.strip(s), strips.range[s]);
  return cut;
}

StaticRemoval::StaticRemoval(const DetailedMesh& detailed, const TriangleStrips& strips)
    : sequence_(detailed.sequence),
      level_(detailed.sequence.step_count()),
      slots_(strips),
      first_(detailed.mesh.vertex_count(), kNone),
      last_(detailed.mesh.vertex_count(), kNone) {
  for (std::uint32_t s = 0; s < strips.count(); ++s) {
    for (const std::uint32_t v : strips.strip(s)) {
      if (last_[v] != kNone && nodes_[last_[v]].strip == s) continue;
      const auto node = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back({s, kNone});
      (first_[v] == kNone ? first_[v] : nodes_[last_[v]].next) = node;
      last_[v] = node;
    }
  }
  const std::vector<SeamTriangle> apart = seam_triangles(detailed);
  std::vector<std::uint8_t> used(apart.size(), 0);
  for (std::uint32_t s = 0; s < strips.count() && !apart.empty(); ++s) {
    if (strips.strip(s).size() != 3) continue;
    const SeamTriangle key{rotated(strip_triangle(strips.strip(s), 0)), 0};
    auto i =
        static_cast<std::size_t>(std::lower_bound(apart.begin(), apart.end(), key) - apart.begin());
    while (i < apart.size() && apart[i].corners == key.corners && used[i]) ++i;
    if (i == apart.size() || apart[i].corners != key.corners) continue;
    used[i] = 1;
    lone_.push_back({apart[i].level, s});
  }
  std::stable_sort(lone_.begin(), lone_.end(),
                   [](const LoneTriangle& a, const LoneTriangle& b) { return a.level < b.level; });
}

std::span<const StripChange> StaticRemoval::collapse() {
  changes_.clear();
  const std::uint32_t begin = sequence_.vertices[level_ - 1], end = sequence_.vertices[level_];
  for (std::uint32_t v = begin; v < end; ++v) move_vertex(v, v - begin);
  std::stable_sort(changes_.begin(), changes_.end(),
                   [](const StripChange& a, const StripChange& b) { return a.strip < b.strip; });
  const auto collapses = static_cast<std::uint32_t>(changes_.size());
  for (std::uint32_t i = 0, next = 0; i < collapses; i = next) {
    const std::uint32_t strip = changes_[i].strip;
    std::uint32_t low = kNone, high = 0;
    for (next = i; next < collapses && changes_[next].strip == strip; ++next) {
      low = std::min(low, changes_[next].position);
      high = std::max(high, changes_[next].position);
    }
    remove_pairs(strip, low, high);
  }
  for (; !lone_.empty() && lone_.back().level == level_; lone_.pop_back())
    if (slots_.length(lone_.back().strip) >= kLeastStrip) remove(lone_.back().strip, 1);
  std::stable_sort(changes_.begin(), changes_.end(),
                   [](const StripChange& a, const StripChange& b) { return a.strip < b.strip; });
  --level_;
  return changes_;
}

void StaticRemoval::move_vertex(std::uint32_t vertex, std::uint32_t moved) {
  const std::uint32_t target = sequence_.target[vertex];
  for (std::uint32_t node = first_[vertex]; node != kNone;) {
    const auto [strip, next] = nodes_[node];
    bool found = false;
    const std::uint32_t length = slots_.length(strip);
    for (std::uint32_t i = 0; length >= kLeastStrip && i < length; ++i) {
      if (slots_.at(strip, i) != vertex) continue;
      slots_.set(strip, i, target);
      changes_.push_back({strip, i, moved, StripChange::Kind::kCollapse});
      found = true;
    }
    if (found) {
      nodes_[node].next = kNone;
      (first_[target] == kNone ? first_[target] : nodes_[last_[target]].next) = node;
      last_[target] = node;
    }
    node = next;
  }
}

// Takes out pairs near the slots [low, high] until none is redundant.
void StaticRemoval::remove_pairs(std::uint32_t strip, std::uint32_t low, std::uint32_t high) {
  low = low < 3 ? 0 : low - 3;
  high += 3;
  for (std::uint32_t p = low; p <= high && p < slots_.length(strip);) {
    const std::uint32_t length = slots_.length(strip);
    if (p + 1 < length && is_redundant(strip, p)) {
      remove(strip, p);
    } else if (p + 1 == length && ends_degenerate(strip)) {
      remove(strip, length);
    } else {
      ++p;
      continue;
    }
    if (slots_.length(strip) < kLeastStrip) return;
    // What stood behind has come nearer, and what stands before may now be redundant.
    p = p < 4 ? 0 : p - 4;
  }
}

bool StaticRemoval::ends_degenerate(std::uint32_t strip) const {
  const std::uint32_t end = slots_.length(strip);
  return is_degenerate(
      Corners{slots_.at(strip, end - 1), slots_.at(strip, end - 2), slots_.at(strip, end - 3)});
}

// Whether the strip draws the same triangles without the two indices at `position`.
bool StaticRemoval::is_redundant(std::uint32_t strip, std::uint32_t position) const {
  const std::uint32_t length = slots_.length(strip), p = position;
  const auto before = [&](std::uint32_t i) { return slots_.at(strip, i); };
  const auto after = [&](std::uint32_t i) { return slots_.at(strip, i < p ? i : i + 2); };
  const std::uint32_t begin = p < 2 ? 0 : p - 2;
  Window<decltype(before)> with;
  for (std::uint32_t i = begin; i < p + 2 && i + 2 < length; ++i) with.add(before, i);
  if (with.count > 2) return false;
  Window<decltype(after)> without;
  for (std::uint32_t i = begin; i < p && i + 2 < length - 2; ++i) without.add(after, i);
  if (with.count != without.count) return false;
  with.sort_two();
  without.sort_two();
  return std::equal(with.triangles.begin(), with.triangles.begin() + with.count,
                    without.triangles.begin());
}

void StaticRemoval::remove(std::uint32_t strip, std::uint32_t position) {
  const bool one = position == slots_.length(strip) ||
                   slots_.at(strip, position) == slots_.at(strip, position + 1);
  slots_.remove(strip, position);
  changes_.push_back(
      {strip, position, 0, one ? StripChange::Kind::kRemoveOne : StripChange::Kind::kRemoveTwo});
}

}  // namespace varifold
