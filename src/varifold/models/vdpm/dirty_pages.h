// Which pages of a growing buffer were written; asking costs nothing where nothing was.
#pragma once

#include <varifold/view/draw_list.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Pages of 2^kBits elements (vertices, triangles). Allocates in grow() only.
class DirtyPages {
 public:
  static constexpr std::uint32_t kBits = 8;
  static constexpr std::uint32_t kSize = 1u << kBits;

  /// Room for so many elements; none of the new ones is marked.
  void grow(std::size_t elements) {
    const std::size_t pages = (elements + kSize - 1) >> kBits;
    if (pages <= marked_.size()) return;
    marked_.resize(pages, 0);
    pages_.reserve(marked_.capacity());
    ranges_.reserve(marked_.capacity());
  }
  void mark(std::uint32_t element) {
    const std::uint32_t page = element >> kBits;
    if (marked_[page] != 0) return;
    marked_[page] = 1;
    pages_.push_back(page);
  }
  /// What is marked and below `size`, each element as `scale` ones of the buffer; forgets all
  /// marks. Valid until the next call. O(p log p) for p pages.
  [[nodiscard]] std::span<const ElementRange> take(std::uint32_t size, std::uint32_t scale) {
    std::sort(pages_.begin(), pages_.end());
    ranges_.clear();
    for (const std::uint32_t page : pages_) {
      marked_[page] = 0;
      const std::uint32_t first = page << kBits;
      if (first >= size) continue;
      const std::uint32_t count = std::min(size - first, kSize);
      if (!ranges_.empty() && ranges_.back().first + ranges_.back().count == first * scale)
        ranges_.back().count += count * scale;
      else
        ranges_.push_back({first * scale, count * scale});
    }
    pages_.clear();
    return ranges_;
  }
  [[nodiscard]] std::size_t bytes() const {
    return marked_.capacity() + pages_.capacity() * sizeof(std::uint32_t) +
           ranges_.capacity() * sizeof(ElementRange);
  }

 private:
  std::vector<std::uint8_t> marked_;  // per page
  std::vector<std::uint32_t> pages_;  // those that are marked
  std::vector<ElementRange> ranges_;
};

/// Grows by a quarter, so that buffers do not take up to twice what they need.
template <class T>
void reserve_for(std::vector<T>& buffer, std::size_t size) {
  if (size > buffer.capacity()) buffer.reserve(size + size / 4 + 64);
}

}  // namespace varifold
