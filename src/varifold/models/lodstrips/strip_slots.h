// Strips that get shorter and longer again in the places that they have at full detail.
#pragma once

#include <varifold/strip/triangle_strips.h>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace varifold {

/// A strip of fewer indices draws nothing.
inline constexpr std::uint32_t kLeastStrip = 3;

/// No strip has more indices, so that a position fits 16 bits and no change shifts more than that.
inline constexpr std::uint32_t kMostStrip = 0xffff;

/// One buffer in which every strip has the place that it fills at full detail, where it is longest.
/// What is removed from a strip stays behind its end, so that putting it back needs no values from
/// elsewhere, and leaves the very bytes that were there before.
class StripSlots {
 public:
  /// A copy of the strips. `strips` must outlive this.
  explicit StripSlots(const TriangleStrips& strips)
      : first_(strips.first.data()), indices_(strips.indices), lengths_(strips.count()) {
    for (std::uint32_t s = 0; s < strips.count(); ++s) lengths_[s] = first_[s + 1] - first_[s];
  }

  [[nodiscard]] std::uint32_t strip_count() const {
    return static_cast<std::uint32_t>(lengths_.size());
  }
  [[nodiscard]] std::uint32_t first(std::uint32_t strip) const { return first_[strip]; }
  [[nodiscard]] std::uint32_t capacity(std::uint32_t strip) const {
    return first_[strip + 1] - first_[strip];
  }
  [[nodiscard]] std::uint32_t length(std::uint32_t strip) const { return lengths_[strip]; }
  [[nodiscard]] const std::vector<std::uint32_t>& indices() const { return indices_; }
  [[nodiscard]] std::uint32_t at(std::uint32_t strip, std::uint32_t position) const {
    return indices_[first_[strip] + position];
  }
  void set(std::uint32_t strip, std::uint32_t position, std::uint32_t vertex) {
    indices_[first_[strip] + position] = vertex;
  }

  /// Whether remove() is allowed there.
  [[nodiscard]] bool can_remove(std::uint32_t strip, std::uint32_t position) const {
    const std::uint32_t length = lengths_[strip];
    return length >= 2 && (position <= length - 2 || position == length);
  }
  /// Takes out the two indices at `position`, which go behind the new end, in front of those
  /// removed before; or, where `position` is the length, the last index alone. O(what stands
  /// behind).
  void remove(std::uint32_t strip, std::uint32_t position) {
    assert(can_remove(strip, position));
    if (position == lengths_[strip]) {
      --lengths_[strip];
      return;
    }
    lengths_[strip] -= 2;
    std::uint32_t* from = indices_.data() + first_[strip] + position;
    const std::uint32_t a = from[0], b = from[1], behind = lengths_[strip] - position;
    std::memmove(from, from + 2, behind * sizeof(std::uint32_t));
    from[behind] = a;
    from[behind + 1] = b;
  }
  /// Undoes the last remove() that was not undone; it was at the same position.
  void restore(std::uint32_t strip, std::uint32_t position) {
    if (position > lengths_[strip]) {
      ++lengths_[strip];
      return;
    }
    assert(lengths_[strip] + 2 <= capacity(strip));
    std::uint32_t* to = indices_.data() + first_[strip] + position;
    const std::uint32_t behind = lengths_[strip] - position;
    const std::uint32_t a = to[behind], b = to[behind + 1];
    std::memmove(to + 2, to, behind * sizeof(std::uint32_t));
    to[0] = a;
    to[1] = b;
    lengths_[strip] += 2;
  }

  [[nodiscard]] std::size_t bytes() const {
    return (indices_.size() + lengths_.size()) * sizeof(std::uint32_t);
  }

 private:
  const std::uint32_t* first_;
  std::vector<std::uint32_t> indices_;
  std::vector<std::uint32_t> lengths_;
};

}  // namespace varifold
