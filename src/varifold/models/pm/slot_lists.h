// Short lists of numbers, one a vertex, that grow, and give parts of themselves to others.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold::pm {

/// Lists keep the order in which their numbers came. Up to 13 numbers lie in the list itself, one
/// cache line; longer ones in a common array, where they double when they grow.
class SlotLists {
 public:
  [[nodiscard]] std::uint32_t list_count() const {
    return static_cast<std::uint32_t>(lists_.size());
  }
  [[nodiscard]] std::span<const std::uint32_t> list(std::uint32_t index) const {
    const List& list = lists_[index];
    return {list.capacity == kInside ? list.inside.data() : pool_.data() + list.first, list.count};
  }
  void reserve(std::size_t lists) { lists_.reserve(lists); }
  void add_lists(std::uint32_t count) { lists_.resize(lists_.size() + count); }

  /// Begins to load a list that will be needed soon.
  void prefetch(std::uint32_t index) const { __builtin_prefetch(&lists_[index]); }

  void append(std::uint32_t index, std::uint32_t number) {
    List& list = lists_[index];
    if (list.count == list.capacity) grow(list, list.count + 1);
    numbers(list)[list.count++] = number;
  }
  /// Takes `moved`, a part of list `from` in its order, to the end of list `to`, another one.
  void move(std::uint32_t from, std::span<const std::uint32_t> moved, std::uint32_t to) {
    List& target = lists_[to];
    const auto count = static_cast<std::uint32_t>(moved.size());
    if (target.count + count > target.capacity) grow(target, target.count + count);
    std::copy(moved.begin(), moved.end(), numbers(target) + target.count);
    target.count += count;

    List& source = lists_[from];
    std::uint32_t* number = numbers(source);
    std::uint32_t kept = 0, taken = 0;
    for (std::uint32_t i = 0; i < source.count; ++i) {
      const std::uint32_t candidate = number[i];
      const bool takes = taken < count && candidate == moved[taken];
      taken += takes ? 1 : 0;
      number[kept] = candidate;
      kept += takes ? 0 : 1;
    }
    source.count = kept;
  }

 private:
  static constexpr std::uint32_t kInside = 13;
  struct alignas(64) List {
    std::uint32_t count = 0;
    std::uint32_t capacity = kInside;
    std::uint32_t first = 0;  // in pool_, with a greater capacity
    std::array<std::uint32_t, kInside> inside;
  };

  [[nodiscard]] std::uint32_t* numbers(List& list) {
    return list.capacity == kInside ? list.inside.data() : pool_.data() + list.first;
  }
  void grow(List& list, std::uint32_t least) {
    const auto first = static_cast<std::uint32_t>(pool_.size());
    const std::uint32_t capacity = std::bit_ceil(std::max(least, kInside + 1));
    pool_.resize(pool_.size() + capacity);
    std::copy_n(numbers(list), list.count, pool_.data() + first);
    list.first = first;
    list.capacity = capacity;
  }

  std::vector<List> lists_;
  std::vector<std::uint32_t> pool_;
};

}  // namespace varifold::pm
