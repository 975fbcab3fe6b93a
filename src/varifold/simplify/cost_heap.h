// A priority queue of points whose costs change and may be negative.
#pragma once

#include <varifold/base/math.h>
#include <algorithm>
#include <cstdint>
#include <vector>

namespace varifold {

/// A heap of four children a node that knows where each point is, so that its cost can be changed
/// in place. Exact, and of equal costs the lower point comes first: the order depends on nothing
/// but costs. BucketQueue is faster, but only for costs that are positive and never fall.
class CostHeap {
 public:
  explicit CostHeap(std::uint32_t points) : place_(points, kNone) {}

  [[nodiscard]] bool empty() const { return entries_.empty(); }
  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] bool contains(std::uint32_t point) const { return place_[point] != kNone; }
  /// The point of least cost, and that cost; not empty.
  [[nodiscard]] std::uint32_t top() const { return entries_[0].point; }
  [[nodiscard]] float top_cost() const { return entries_[0].cost; }

  /// Puts the point in, or changes its cost. O(log n). `cost` is not NaN.
  void set(std::uint32_t point, float cost) {
    std::uint32_t at = place_[point];
    if (at == kNone) {
      at = static_cast<std::uint32_t>(entries_.size());
      entries_.push_back({cost, point});
      place_[point] = at;
    } else {
      entries_[at].cost = cost;
    }
    sink(rise(at));
  }

  /// Takes the point out, if it is in. O(log n).
  void remove(std::uint32_t point) {
    const std::uint32_t at = place_[point];
    if (at == kNone) return;
    place_[point] = kNone;
    const Entry last = entries_.back();
    entries_.pop_back();
    if (last.point == point) return;
    put(at, last);
    sink(rise(at));
  }

  [[nodiscard]] std::size_t bytes() const {
    return place_.capacity() * sizeof(place_[0]) + entries_.capacity() * sizeof(Entry);
  }

 private:
  struct Entry {
    float cost;
    std::uint32_t point;
    [[nodiscard]] bool before(const Entry& other) const {
      return cost != other.cost ? cost < other.cost : point < other.point;
    }
  };

  void put(std::uint32_t at, const Entry& entry) {
    entries_[at] = entry;
    place_[entry.point] = at;
  }

  std::uint32_t rise(std::uint32_t at) {
    const Entry entry = entries_[at];
    while (at > 0 && entry.before(entries_[(at - 1) / 4])) {
      put(at, entries_[(at - 1) / 4]);
      at = (at - 1) / 4;
    }
    put(at, entry);
    return at;
  }

  void sink(std::uint32_t at) {
    const Entry entry = entries_[at];
    const auto size = static_cast<std::uint32_t>(entries_.size());
    while (4 * at + 1 < size) {
      const std::uint32_t end = std::min(4 * at + 5, size);
      std::uint32_t least = 4 * at + 1;
      for (std::uint32_t child = least + 1; child < end; ++child)
        if (entries_[child].before(entries_[least])) least = child;
      if (!entries_[least].before(entry)) break;
      put(at, entries_[least]);
      at = least;
    }
    put(at, entry);
  }

  std::vector<Entry> entries_;
  std::vector<std::uint32_t> place_;  // per point: where in `entries_`, or kNone
};

}  // namespace varifold
