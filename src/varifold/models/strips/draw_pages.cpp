#include <varifold/models/strips/draw_pages.h>

#include <varifold/models/strips/strip_filter.h>
#include <algorithm>

namespace varifold {

DrawPages::DrawPages(std::span<const std::uint32_t> first_slots,
                     std::span<const std::uint32_t> strip_ranges, const TriangleMesh& mesh)
    : first_slots_(first_slots) {
  const auto strips = static_cast<std::uint32_t>(strip_ranges.size());
  lengths_.assign(strips, 0);
  std::uint32_t end = 0, longest = 0;
  for (std::uint32_t s = 0; s < strips; ++s) {
    // With room for a restart.
    const std::uint32_t room = first_slots[s + 1] - first_slots[s] + 1;
    if (s == 0 || strip_ranges[s] != strip_ranges[s - 1] ||
        end - pages_.back().first_index + room > kPageIndices) {
      const std::uint32_t range = strip_ranges[s];
      pages_.push_back({s, 0, end, 0, mesh.ranges.empty() ? 0 : mesh.ranges[range].material});
    }
    ++pages_.back().strip_count;
    end += room;
    longest = std::max(longest, end - pages_.back().first_index);
  }
  indices_.assign(end, kStripRestart);
  before_.resize(longest);
  touched_.assign((first_slots.back() >> kBlockBits) + 1, 1);
  ranges_.reserve(pages_.size());
  changed_.reserve(pages_.size());
}

bool DrawPages::is_touched(std::uint32_t first_slot, std::uint32_t end_slot) const {
  if (first_slot == end_slot) return false;
  const auto first = touched_.begin() + (first_slot >> kBlockBits);
  const auto last = touched_.begin() + ((end_slot - 1) >> kBlockBits);
  return std::find(first, last + 1, std::uint8_t{1}) != last + 1;
}

void DrawPages::refresh(std::span<const std::uint32_t> slots) {
  changed_.clear();
  for (Page& page : pages_)
    if (is_touched(first_slots_[page.first_strip],
                   first_slots_[page.first_strip + page.strip_count]))
      rebuild(page, slots);
  std::fill(touched_.begin(), touched_.end(), std::uint8_t{0});
}

void DrawPages::rebuild(Page& page, std::span<const std::uint32_t> slots) {
  std::uint32_t* to = indices_.data() + page.first_index;
  const std::uint32_t old_used = page.used;
  std::copy_n(to, old_used, before_.data());
  const std::uint32_t* from = before_.data();
  std::uint32_t used = 0;
  for (std::uint32_t s = page.first_strip; s < page.first_strip + page.strip_count; ++s) {
    const std::uint32_t begin = used > 0 ? used + 1 : 0;
    const std::uint32_t old_length = lengths_[s];
    const std::uint32_t first = first_slots_[s], end = first_slots_[s + 1];
    if (is_touched(first, end))
      lengths_[s] = filter_strip(slots.subspan(first, end - first), to + begin);
    else
      std::copy_n(from, old_length, to + begin);
    if (old_length > 0) from += old_length + 1;
    if (lengths_[s] == 0) continue;
    if (used > 0) to[used] = kStripRestart;
    used = begin + lengths_[s];
  }
  // What is left behind must not tell of what was there, and the filter may have written beyond.
  const std::uint32_t end = page.first_strip + page.strip_count;
  const std::uint32_t room = first_slots_[end] - first_slots_[page.first_strip] + page.strip_count;
  std::fill(to + used, to + room, kStripRestart);
  page.used = used;
  changed_.push_back({page.first_index, std::max(used, old_used)});
}

std::span<const DrawRange> DrawPages::ranges(float level) {
  ranges_.clear();
  for (const Page& page : pages_)
    if (page.used > 0)
      ranges_.push_back({page.first_index, page.used, Primitive::kStrips, page.material, level});
  return ranges_;
}

std::size_t DrawPages::bytes() const {
  return (lengths_.size() + indices_.size() + before_.size()) * sizeof(std::uint32_t) +
         pages_.size() * sizeof(Page) + touched_.size() + ranges_.capacity() * sizeof(DrawRange) +
         changed_.capacity() * sizeof(ElementRange);
}

}  // namespace varifold
