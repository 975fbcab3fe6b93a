#include <varifold/models/strips/draw_pages.h>

#include <varifold/models/common/strip_filter.h>
#include <varifold/models/strips/strip_pieces.h>
#include <algorithm>

namespace varifold {

DrawPages::DrawPages(const StripFramework& model) : model_(&model) {
  const TriangleMesh& mesh = model.attributes();
  const auto first_slots = model.first_slots();
  const auto ranges = model.strip_ranges();
  lengths_.assign(model.strip_count(), 0);
  std::uint32_t end = 0, longest = 0, longest_strip = 0;
  for (std::uint32_t s = 0; s < model.strip_count(); ++s) {
    const std::uint32_t length = first_slots[s + 1] - first_slots[s];
    const auto slivers = static_cast<std::uint32_t>(model.slivers_of(s).size());
    const std::uint32_t room = length + 1 + kIndicesPerSliver * slivers;  // and a restart
    if (s == 0 || ranges[s] != ranges[s - 1] || pages_.back().room + room > kPageIndices)
      pages_.push_back(
          {s, 0, end, 0, 0, mesh.ranges.empty() ? 0 : mesh.ranges[ranges[s]].material});
    ++pages_.back().strip_count;
    pages_.back().room += room;
    end += room;
    longest = std::max(longest, pages_.back().room);
    if (slivers > 0) longest_strip = std::max(longest_strip, length);
  }
  indices_.assign(end, kStripRestart);
  before_.resize(longest);
  piece_.resize(longest_strip + 1);
  touched_.assign((model.slot_count() >> kBlockBits) + 1, 1);
  ranges_.reserve(pages_.size());
  changed_.reserve(pages_.size());
}

bool DrawPages::is_touched(std::uint32_t first_slot, std::uint32_t end_slot) const {
  if (first_slot == end_slot) return false;
  const std::uint32_t last = (end_slot - 1) >> kBlockBits;
  for (std::uint32_t block = first_slot >> kBlockBits; block <= last; ++block)
    if (touched_[block] != 0) return true;
  return false;
}

void DrawPages::refresh(std::span<const std::uint32_t> slots) {
  changed_.clear();
  for (Page& page : pages_)
    if (is_touched(model_->first_slots()[page.first_strip],
                   model_->first_slots()[page.first_strip + page.strip_count]))
      rebuild(page, slots);
  std::fill(touched_.begin(), touched_.end(), std::uint8_t{0});
}

// Writes what is to be drawn of a strip, and returns its length.
std::uint32_t DrawPages::filter(std::uint32_t strip, std::span<const std::uint32_t> slots,
                                std::uint32_t* to) {
  const std::uint32_t first = model_->first_slots()[strip];
  const std::uint32_t end = model_->first_slots()[strip + 1];
  const auto slivers = model_->slivers_of(strip);
  if (slivers.empty()) return filter_strip(slots.subspan(first, end - first), to);
  std::uint32_t length = 0;
  for_each_piece(slots, first, end, slivers, model_->attributes().positions,
                 [&](const StripPiece& piece) {
                   const auto all = slots.subspan(piece.begin, piece.end - piece.begin);
                   std::span<const std::uint32_t> part = all;
                   if (piece.is_odd) {
                     piece_[0] = all[0];
                     std::copy(all.begin(), all.end(), piece_.begin() + 1);
                     part = std::span(piece_).first(all.size() + 1);
                   }
                   const std::uint32_t begin = length > 0 ? length + 1 : 0;
                   const std::uint32_t left = filter_strip(part, to + begin);
                   if (left == 0) return;
                   if (length > 0) to[length] = kStripRestart;
                   length = begin + left;
                 });
  return length;
}

void DrawPages::rebuild(Page& page, std::span<const std::uint32_t> slots) {
  const auto first_slots = model_->first_slots();
  std::uint32_t* to = indices_.data() + page.first_index;
  const std::uint32_t old_used = page.used;
  std::copy_n(to, old_used, before_.data());
  const std::uint32_t* from = before_.data();
  std::uint32_t used = 0;
  for (std::uint32_t s = page.first_strip; s < page.first_strip + page.strip_count; ++s) {
    const std::uint32_t begin = used > 0 ? used + 1 : 0;
    const std::uint32_t old_length = lengths_[s];
    if (is_touched(first_slots[s], first_slots[s + 1]))
      lengths_[s] = filter(s, slots, to + begin);
    else
      std::copy_n(from, old_length, to + begin);
    if (old_length > 0) from += old_length + 1;
    if (lengths_[s] == 0) continue;
    if (used > 0) to[used] = kStripRestart;
    used = begin + lengths_[s];
  }
  // What is left behind must not tell of what was there, and the filter may have written beyond.
  std::fill(to + used, to + page.room, kStripRestart);
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
  return (lengths_.size() + indices_.size() + before_.size() + piece_.size()) *
             sizeof(std::uint32_t) +
         pages_.size() * sizeof(Page) + touched_.size() + ranges_.capacity() * sizeof(DrawRange) +
         changed_.capacity() * sizeof(ElementRange);
}

}  // namespace varifold
