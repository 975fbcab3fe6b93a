// Storage for many short arrays that grow and shrink: blocks whose size is a power of two.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

/// Blocks of one flat array, addressed by offset; freed blocks are used again for others of their
/// size. Growing moves the array, so pointers hold until the next allocate(). O(1) amortised.
template <class T, std::uint32_t kSmallest>
class BlockPool {
 public:
  [[nodiscard]] std::uint32_t allocate(std::uint32_t entries) {
    auto& free_list = free_[static_cast<std::size_t>(size_class(entries))];
    if (!free_list.empty()) {
      const std::uint32_t offset = free_list.back();
      free_list.pop_back();
      return offset;
    }
    const auto offset = static_cast<std::uint32_t>(entries_.size());
    entries_.resize(offset + std::size_t{capacity(entries)});
    return offset;
  }
  /// `entries` as they were allocated, or any number of the same capacity.
  void release(std::uint32_t offset, std::uint32_t entries) {
    free_[static_cast<std::size_t>(size_class(entries))].push_back(offset);
  }
  /// How many entries a block allocated for `entries` has room for.
  [[nodiscard]] static std::uint32_t capacity(std::uint32_t entries) {
    return 1u << size_class(entries);
  }
  [[nodiscard]] T* at(std::uint32_t offset) { return entries_.data() + offset; }
  [[nodiscard]] const T* at(std::uint32_t offset) const { return entries_.data() + offset; }
  /// Entries of all blocks, free ones too.
  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] std::size_t bytes() const { return entries_.capacity() * sizeof(T); }

 private:
  static int size_class(std::uint32_t entries) {
    return std::bit_width(std::max(entries, kSmallest) - 1);
  }
  std::vector<T> entries_;
  std::array<std::vector<std::uint32_t>, 32> free_;
};

}  // namespace varifold
