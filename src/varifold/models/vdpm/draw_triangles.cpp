#include <varifold/models/vdpm/draw_triangles.h>

#include <algorithm>

namespace varifold {

DrawTriangles::DrawTriangles(std::uint32_t triangles, std::span<const MaterialRange> ranges)
    : one_range_(ranges.size() < 2), place_of_(triangles, kNone) {
  ranges_.resize(std::max<std::size_t>(1, ranges.size()));
  for (std::size_t r = 0; r < ranges.size(); ++r) ranges_[r].material = ranges[r].material;
  draw_ranges_.reserve(ranges_.size());
}

void DrawTriangles::grow(std::uint32_t places) {
  reserve_for(triangle_at_, places);
  const std::size_t room = triangle_at_.capacity();
  indices_.reserve(3 * room);
  dirty_.grow(room);
  // All that there is room for: the size of what is drawn is count_.
  triangle_at_.resize(room);
  indices_.resize(3 * room, 0);
}

void DrawTriangles::reserve(std::uint32_t triangles) {
  const std::uint32_t partial = one_range_ ? 0 : static_cast<std::uint32_t>(ranges_.size());
  const std::uint32_t places = triangles + partial * kPage;
  if (places > triangle_at_.size()) grow(places);
  if (one_range_) return;
  const std::size_t pages = (places >> kPageBits) + 1;
  reserve_for(page_range_, pages);
  reserve_for(free_pages_, pages);
  reserve_for(draw_ranges_, pages);
  for (Range& range : ranges_) reserve_for(range.pages, pages);
}

std::uint32_t DrawTriangles::next_place_of(std::uint32_t range) {
  Range& own = ranges_[range];
  const std::uint32_t at = own.count++;
  ++count_;
  if ((at >> kPageBits) == own.pages.size()) {
    std::uint32_t page = 0;
    if (free_pages_.empty()) {
      page = static_cast<std::uint32_t>(page_range_.size());
      page_range_.push_back(range);
      free_pages_.reserve(page_range_.capacity());
      draw_ranges_.reserve(page_range_.capacity());
      const std::uint32_t places = (page + 1) << kPageBits;
      if (places > triangle_at_.size()) grow(places);
    } else {
      page = free_pages_.back();
      free_pages_.pop_back();
      page_range_[page] = range;
    }
    own.pages.push_back(page);
  }
  return own.pages[at >> kPageBits] << kPageBits | (at & (kPage - 1));
}

// Takes the last place of the range that `place` is of.
std::uint32_t DrawTriangles::drop_last_of(std::uint32_t place) {
  Range& own = ranges_[page_range_[place >> kPageBits]];
  const std::uint32_t at = --own.count;
  --count_;
  const std::uint32_t page = own.pages[at >> kPageBits];
  if ((at & (kPage - 1)) == 0) {
    own.pages.pop_back();
    free_pages_.push_back(page);
  }
  return page << kPageBits | (at & (kPage - 1));
}

std::span<const std::uint32_t> DrawTriangles::indices() const {
  return std::span(indices_).first(3 * std::size_t{places()});
}

std::span<const DrawRange> DrawTriangles::ranges(float level) {
  draw_ranges_.clear();
  if (one_range_) {
    draw_ranges_.push_back({0, 3 * count_, Primitive::kTriangles, ranges_[0].material, level});
    return draw_ranges_;
  }
  for (const Range& range : ranges_) {
    for (std::uint32_t i = 0; i < range.pages.size(); ++i) {
      const std::uint32_t first = 3 * (range.pages[i] << kPageBits);
      const std::uint32_t count = 3 * std::min(kPage, range.count - (i << kPageBits));
      const bool joins = i > 0 && range.pages[i] == range.pages[i - 1] + 1;
      if (joins)
        draw_ranges_.back().index_count += count;
      else
        draw_ranges_.push_back({first, count, Primitive::kTriangles, range.material, level});
    }
  }
  return draw_ranges_;
}

std::size_t DrawTriangles::bytes() const {
  std::size_t words = indices_.capacity() + triangle_at_.capacity() + place_of_.size() +
                      page_range_.capacity() + free_pages_.capacity();
  for (const Range& range : ranges_) words += range.pages.capacity();
  return words * sizeof(std::uint32_t) + draw_ranges_.capacity() * sizeof(DrawRange) +
         dirty_.bytes();
}

}  // namespace varifold
