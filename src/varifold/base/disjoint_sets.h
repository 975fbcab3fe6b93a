// Union-find over small integers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace varifold {

/// Sets of the numbers [0, count). The representative of a set is its smallest member, so results
/// do not depend on the order of the unions. Near-constant time each (path halving).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count = 0) { reset(count); }

  /// Starts again with `count` sets of one; allocates only to grow.
  void reset(std::size_t count) {
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0u);
    set_count_ = count;
  }
  /// The smallest member of the set of x.
  std::uint32_t find(std::uint32_t x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }
  /// Returns whether a and b were in different sets.
  bool unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    if (a < b)
      parent_[b] = a;
    else
      parent_[a] = b;
    --set_count_;
    return true;
  }
  [[nodiscard]] std::size_t size() const { return parent_.size(); }
  [[nodiscard]] std::size_t set_count() const { return set_count_; }

 private:
  std::vector<std::uint32_t> parent_;
  std::size_t set_count_ = 0;
};

}  // namespace varifold
