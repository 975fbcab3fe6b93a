// Notes which parts of a buffer were written, in blocks, for DrawList's changed ranges.
#pragma once

#include <varifold/view/draw_list.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// One byte per block of 2^kBits elements. Allocates in reset() only.
class ChangedBlocks {
 public:
  static constexpr std::uint32_t kBits = 12;

  /// Everything is new.
  void reset(std::size_t elements) {
    size_ = static_cast<std::uint32_t>(elements);
    blocks_.assign((elements >> kBits) + 1, 1);
    ranges_.reserve(blocks_.size());
  }
  void mark(std::uint32_t element) { blocks_[element >> kBits] = 1; }
  /// Elements [first, first + count).
  void mark(std::uint32_t first, std::uint32_t count) {
    if (count == 0) return;
    for (std::uint32_t i = first >> kBits; i <= (first + count - 1) >> kBits; ++i) blocks_[i] = 1;
  }
  void mark_all() { std::fill(blocks_.begin(), blocks_.end(), std::uint8_t{1}); }

  /// The changed elements since the last call, neighbouring blocks joined; valid until the next.
  /// `behind`: up to so many elements behind a marked one have changed too.
  [[nodiscard]] std::span<const ElementRange> take(std::uint32_t behind = 0) {
    ranges_.clear();
    for (std::uint32_t i = 0; i < blocks_.size() && (i << kBits) < size_; ++i) {
      if (!blocks_[i]) continue;
      blocks_[i] = 0;
      const std::uint32_t first = i << kBits;
      const std::uint32_t end = first + std::min(size_ - first, (1u << kBits) + behind);
      if (!ranges_.empty() && ranges_.back().first + ranges_.back().count >= first)
        ranges_.back().count = end - ranges_.back().first;
      else
        ranges_.push_back({first, end - first});
    }
    return ranges_;
  }
  [[nodiscard]] std::size_t bytes() const {
    return blocks_.size() + ranges_.capacity() * sizeof(ElementRange);
  }

 private:
  std::uint32_t size_ = 0;
  std::vector<std::uint8_t> blocks_;
  std::vector<ElementRange> ranges_;
};

}  // namespace varifold
