#include <varifold/models/mts/strip_reduction.h>

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace varifold::mts {

namespace {

using Corners = std::array<std::uint32_t, 3>;

bool is_real(const Corners& c) { return c[0] != c[1] && c[1] != c[2] && c[2] != c[0]; }

// Least corner first, the orientation kept.
Corners canonical(Corners c) {
  std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
  return c;
}

Corners oriented(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool odd) {
  return canonical(odd ? Corners{b, a, c} : Corners{a, b, c});
}

bool is_real_at(const std::vector<StripItem>& items, std::size_t i) {
  return is_real({items[i].vertex, items[i + 1].vertex, items[i + 2].vertex});
}

// The triangles of a short run of indices, where at most two of them are real.
struct RealTriangles {
  std::array<Corners, 2> corners{};
  std::size_t count = 0;

  // False where there are more.
  bool add(const std::uint32_t* run, std::size_t size) {
    for (std::size_t i = 0; i + 2 < size; ++i) {
      if (!is_real({run[i], run[i + 1], run[i + 2]})) continue;
      if (count == 2) return false;
      corners[count++] = oriented(run[i], run[i + 1], run[i + 2], i % 2 == 1);
    }
    return true;
  }
  // In any order; those that are not there are equal.
  friend bool operator==(const RealTriangles& a, const RealTriangles& b) {
    return a.count == b.count &&
           (a.corners == b.corners ||
            (a.count == 2 && a.corners[0] == b.corners[1] && a.corners[1] == b.corners[0]));
  }
};

// Whether the triangles stay the same without the indices i and i + 1. Those after the pair keep
// their parity, so only triangles that have one of the two, or reach over them, matter.
bool pair_can_go(const std::vector<StripItem>& items, std::size_t i) {
  const std::size_t begin = i >= 2 ? i - 2 : 0;
  const std::size_t end = std::min(items.size(), i + 4);
  std::array<std::uint32_t, 6> with{}, without{};
  std::size_t with_count = 0, without_count = 0;
  for (std::size_t j = begin; j < end; ++j) {
    with[with_count++] = items[j].vertex;
    if (j != i && j != i + 1) without[without_count++] = items[j].vertex;
  }
  RealTriangles before, after;
  return before.add(with.data(), with_count) && after.add(without.data(), without_count) &&
         before == after;
}

// Nothing real before and after: at most this many degenerate triangles can stand in a row at a
// pair that could go, so a removal looks back this far for the next.
constexpr std::size_t kLookBack = 4;

void remove_pairs(std::vector<StripItem>& items) {
  for (std::size_t i = 0; i + 1 < items.size();) {
    if (!pair_can_go(items, i)) {
      ++i;
      continue;
    }
    const auto first = items.begin() + static_cast<std::ptrdiff_t>(i);
    items.erase(first, first + 2);
    i = i > kLookBack ? i - kLookBack : 0;
  }
}

void cut_end(std::vector<StripItem>& items) {
  while (items.size() >= 3 && !is_real_at(items, items.size() - 3)) items.pop_back();
  if (items.size() < 3) items.clear();
}

std::size_t next_real(const std::vector<StripItem>& items, std::size_t i) {
  while (i + 2 < items.size() && !is_real_at(items, i)) ++i;
  return i;
}

bool ends_at(const std::vector<StripItem>& items, std::size_t i) {
  return next_real(items, i + 1) + 2 >= items.size();
}

// A single triangle needs no degenerate one to turn it.
void shorten_single(std::vector<StripItem>& items) {
  const std::size_t i = next_real(items, 0);
  if (i + 2 >= items.size() || !ends_at(items, i)) return;
  const StripItem a = items[i], b = items[i + 1], c = items[i + 2];
  if (i % 2 == 0)
    items = {a, b, c};
  else
    items = {b, StripItem{a.vertex, kNone}, c};
}

}  // namespace

void StripReducer::reduce(std::vector<StripItem>& items) {
  result_.clear();
  for (std::size_t begin = 0; begin < items.size();) {
    std::size_t end = begin;
    while (end < items.size() && items[end].vertex != kStripRestart) ++end;
    const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    part_.assign(at(begin), at(end));
    const std::size_t before = result_.size();
    reduce_part();
    // The restart that divided it from the next part stays where both are still there.
    if (end < items.size() && result_.size() > before) result_.push_back(items[end]);
    begin = end + 1;
  }
  if (!result_.empty() && result_.back().vertex == kStripRestart) result_.pop_back();
  items.swap(result_);
}

void StripReducer::reduce_part() {
  do {
    remove_pairs(part_);
    cut_end(part_);
    shorten_single(part_);
  } while (break_part());
  result_.insert(result_.end(), part_.begin(), part_.end());
}

// Moves the triangles before a long degenerate run to the result, and keeps those after it.
bool StripReducer::break_part() {
  std::size_t i = next_real(part_, 0);
  while (i + 2 < part_.size()) {
    const std::size_t j = next_real(part_, i + 1);
    if (j + 2 >= part_.size()) return false;
    // As they are, j + 3 indices; broken, i + 3 and a restart and 3, and one more where the next
    // triangle must be turned and is not alone.
    const bool turned = j % 2 == 1 && !ends_at(part_, j);
    if (j > i + 4 + (turned ? 1 : 0)) {
      head_.assign(part_.begin(), part_.begin() + static_cast<std::ptrdiff_t>(i + 3));
      shorten_single(head_);
      result_.insert(result_.end(), head_.begin(), head_.end());
      result_.push_back({kStripRestart, kNone});
      // The index before makes a degenerate triangle that turns the next one.
      part_.erase(part_.begin(), part_.begin() + static_cast<std::ptrdiff_t>(j - j % 2));
      return true;
    }
    i = j;
  }
  return false;
}

bool cut_triangle(const std::array<std::uint32_t, 3>& corners, std::vector<StripItem>& items) {
  const Corners wanted = canonical(corners);
  std::size_t begin = 0;  // of the present part
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].vertex == kStripRestart) begin = i + 1;
    if (i < begin + 2) continue;
    const std::size_t first = i - 2;
    const bool odd = (first - begin) % 2 == 1;
    if (oriented(items[first].vertex, items[first + 1].vertex, items[i].vertex, odd) != wanted)
      continue;
    // ... a b | restart | (b) b c ...: the strip goes on with the next triangle, at its parity.
    std::vector<StripItem> between{{kStripRestart, kNone}};
    if (!odd) between.push_back({items[first + 1].vertex, kNone});
    between.push_back({items[first + 1].vertex, kNone});
    items.insert(items.begin() + static_cast<std::ptrdiff_t>(i), between.begin(), between.end());
    return true;
  }
  return false;
}

}  // namespace varifold::mts
