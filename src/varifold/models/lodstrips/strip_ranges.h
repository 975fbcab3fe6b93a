// Draw ranges of strips that change their lengths.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/lodstrips/strip_slots.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// One range per strip that draws something, those of a material range beside each other. A strip
/// that stops drawing leaves its place to the last one of its material range, and gets it back
/// later: as long as strips come back in the opposite order of going, the order depends on the
/// level alone. Allocates in its constructor only.
class StripRanges {
 public:
  /// Of strips at their full lengths. `attributes` names the materials. `strips` must outlive this.
  StripRanges(const TriangleStrips& strips, const TriangleMesh& attributes)
      : first_(strips.first.data()),
        range_(attributes.ranges.size() > 1 ? strips.range.data() : nullptr),
        place_(strips.count()) {
    for (const MaterialRange& range : attributes.ranges) materials_.push_back(range.material);
    if (materials_.empty()) materials_.push_back(0);
    end_.assign(materials_.size(), 0);
    ranges_.reserve(strips.count());
    strip_at_.reserve(strips.count());
    for (std::uint32_t s = 0; s < strips.count(); ++s) {
      const std::uint32_t length = first_[s + 1] - first_[s];
      if (length < kLeastStrip) continue;
      place_[s] = end_[range_of(s)];
      insert(s, length);
    }
  }

  /// The length of a strip was `before` and is `after`. O(1), but O(material ranges) where it
  /// begins or ceases to draw.
  void resize(std::uint32_t strip, std::uint32_t before, std::uint32_t after) {
    const bool drew = before >= kLeastStrip, draws = after >= kLeastStrip;
    if (drew && draws) ranges_[place_[strip]].index_count = after;
    if (drew && !draws) erase(strip);
    if (!drew && draws) insert(strip, after);
  }

  /// Valid until the next resize().
  [[nodiscard]] std::span<const DrawRange> ranges() const { return ranges_; }
  [[nodiscard]] std::size_t bytes() const {
    return (place_.size() + strip_at_.capacity()) * sizeof(std::uint32_t) +
           ranges_.capacity() * sizeof(DrawRange);
  }

 private:
  [[nodiscard]] std::uint32_t range_of(std::uint32_t strip) const {
    return range_ == nullptr ? 0 : range_[strip];
  }
  void move(std::uint32_t from, std::uint32_t to) {
    if (from == to) return;
    ranges_[to] = ranges_[from];
    strip_at_[to] = strip_at_[from];
    place_[strip_at_[to]] = to;
  }

  // The first of each later material goes behind its last; what stands in the strip's place, behind
  // the last of its own.
  void insert(std::uint32_t strip, std::uint32_t length) {
    ranges_.emplace_back();
    strip_at_.push_back(strip);
    const std::uint32_t range = range_of(strip);
    for (std::size_t r = end_.size() - 1; r > range; --r) move(end_[r - 1], end_[r]++);
    const std::uint32_t place = place_[strip];
    move(place, end_[range]++);
    ranges_[place] = {first_[strip], length, Primitive::kStrips, materials_[range]};
    strip_at_[place] = strip;
    place_[strip] = place;
  }
  // The inverse. place_ of the strip stays.
  void erase(std::uint32_t strip) {
    const std::uint32_t range = range_of(strip);
    const std::uint32_t place = place_[strip];
    std::uint32_t gap = --end_[range];
    move(gap, place);
    for (std::size_t r = range + std::size_t{1}; r < end_.size(); ++r) {
      move(--end_[r], gap);
      gap = end_[r];
    }
    ranges_.pop_back();
    strip_at_.pop_back();
  }

  const std::uint32_t* first_;
  const std::uint32_t* range_;            // per strip, where there are several
  std::vector<std::uint32_t> materials_;  // per material range
  std::vector<std::uint32_t> end_;        // per material range, of its part of ranges_
  std::vector<DrawRange> ranges_;
  std::vector<std::uint32_t> strip_at_;  // per entry of ranges_
  std::vector<std::uint32_t> place_;     // per strip: its entry, or that it gets when it comes back
};

}  // namespace varifold
