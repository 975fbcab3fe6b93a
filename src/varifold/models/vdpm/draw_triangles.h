// The triangles of a front in an index buffer without gaps.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/vdpm/dirty_pages.h>
#include <varifold/view/draw_list.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Each triangle has a place in the buffer; where one goes, the last one of its material comes. One
/// material fills the buffer from its beginning; several have pages of 256 triangles, of which the
/// last one of each is not full. 4 bytes a triangle of the model and 16 for each one shown.
class DrawTriangles {
 public:
  /// Shows none. `triangles`: of the model; `ranges`: those of its full mesh.
  DrawTriangles(std::uint32_t triangles, std::span<const MaterialRange> ranges);

  [[nodiscard]] std::uint32_t count() const { return count_; }
  [[nodiscard]] bool is_shown(std::uint32_t triangle) const { return place_of_[triangle] != kNone; }

  /// `range`: of the triangle. O(1) amortised.
  void add(std::uint32_t triangle, std::uint32_t range, const std::array<std::uint32_t, 3>& slots) {
    const std::uint32_t place = one_range_ ? next_place() : next_place_of(range);
    place_of_[triangle] = place;
    triangle_at_[place] = triangle;
    std::uint32_t* const to = indices_.data() + std::size_t{3} * place;
    to[0] = slots[0];
    to[1] = slots[1];
    to[2] = slots[2];
    dirty_.mark(place);
  }
  void remove(std::uint32_t triangle) {
    const std::uint32_t place = place_of_[triangle];
    const std::uint32_t last = one_range_ ? --count_ : drop_last_of(place);
    place_of_[triangle] = kNone;
    if (place == last) return;
    const std::uint32_t moved = triangle_at_[last];
    triangle_at_[place] = moved;
    place_of_[moved] = place;
    std::uint32_t* const to = indices_.data() + std::size_t{3} * place;
    const std::uint32_t* const from = indices_.data() + std::size_t{3} * last;
    to[0] = from[0];
    to[1] = from[1];
    to[2] = from[2];
    dirty_.mark(place);
  }
  void set_corner(std::uint32_t triangle, std::uint32_t corner, std::uint32_t slot) {
    const std::uint32_t place = place_of_[triangle];
    indices_[std::size_t{3} * place + corner] = slot;
    dirty_.mark(place);
  }
  /// The slots of a triangle that is shown.
  [[nodiscard]] std::array<std::uint32_t, 3> corners(std::uint32_t triangle) const {
    const std::uint32_t* const at = indices_.data() + std::size_t{3} * place_of_[triangle];
    return {at[0], at[1], at[2]};
  }

  void reserve(std::uint32_t triangles);
  [[nodiscard]] std::span<const std::uint32_t> indices() const;
  /// What to draw; valid until the next call of either. O(pages) with several materials.
  [[nodiscard]] std::span<const DrawRange> ranges(float level);
  /// What was written since the last call, in indices. Valid until the next.
  [[nodiscard]] std::span<const ElementRange> take_changed() { return dirty_.take(places(), 3); }
  [[nodiscard]] std::size_t bytes() const;

 private:
  static constexpr std::uint32_t kPageBits = 8, kPage = 1u << kPageBits;
  struct Range {
    std::uint32_t material = 0, count = 0;
    std::vector<std::uint32_t> pages;
  };
  std::uint32_t next_place() {
    if (3 * std::size_t{count_} == indices_.size()) grow(count_ + 1);
    return count_++;
  }
  std::uint32_t next_place_of(std::uint32_t range);
  std::uint32_t drop_last_of(std::uint32_t place);
  void grow(std::uint32_t places);
  [[nodiscard]] std::uint32_t places() const {
    return one_range_ ? count_ : static_cast<std::uint32_t>(page_range_.size() << kPageBits);
  }

  bool one_range_ = true;
  std::uint32_t count_ = 0;
  std::vector<std::uint32_t> indices_;
  std::vector<std::uint32_t> triangle_at_;  // per place
  std::vector<std::uint32_t> place_of_;     // per triangle of the model
  std::vector<Range> ranges_;
  std::vector<std::uint32_t> page_range_;  // per page, whose it is
  std::vector<std::uint32_t> free_pages_;
  std::vector<DrawRange> draw_ranges_;
  DirtyPages dirty_;
};

}  // namespace varifold
