// The index buffer that is drawn: strips without their degenerate triangles, in pages.
//
// Based on: [Ramos2008] section 3.4.1.
// Differs: the thesis filters every strip for every frame and draws each by a call of its own; here
//   those alone are filtered that changed, and strips are joined into pages of some thousand
//   indices, so that neither uploads nor calls grow with the number of strips.
#pragma once

#include <varifold/models/strips/strip_framework.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// A page holds consecutive strips of one material, divided by restarts, and keeps its place in the
/// buffer, which has room for them at their longest. Allocates in the constructor only.
class DrawPages {
 public:
  DrawPages() = default;
  /// `model` must outlive this. Everything counts as touched. O(model).
  explicit DrawPages(const StripFramework& model);

  /// Notes that the index at a slot may have changed.
  void touch(std::uint32_t slot) { touched_[slot >> kBlockBits] = 1; }
  /// Filters the strips that were touched since the last call. The buffer depends on `slots` alone.
  /// O(slots of the pages that were touched).
  void refresh(std::span<const std::uint32_t> slots);

  [[nodiscard]] const std::vector<std::uint32_t>& indices() const { return indices_; }
  /// A range for every page with anything in it; `level` as in DrawRange. O(pages).
  [[nodiscard]] std::span<const DrawRange> ranges(float level);
  /// What the last refresh() wrote.
  [[nodiscard]] std::span<const ElementRange> changed() const { return changed_; }

  [[nodiscard]] std::size_t bytes() const;

 private:
  static constexpr std::uint32_t kBlockBits = 5;       // slots of one mark
  static constexpr std::uint32_t kPageIndices = 4096;  // but longer strips have a page of their own
  struct Page {
    std::uint32_t first_strip, strip_count;
    std::uint32_t first_index;  // in indices_
    std::uint32_t room, used;
    std::uint32_t material;
  };
  [[nodiscard]] bool is_touched(std::uint32_t first_slot, std::uint32_t end_slot) const;
  void rebuild(Page& page, std::span<const std::uint32_t> slots);
  std::uint32_t filter(std::uint32_t strip, std::span<const std::uint32_t> slots,
                       std::uint32_t* to);

  const StripFramework* model_ = nullptr;
  std::vector<Page> pages_;
  std::vector<std::uint32_t> lengths_;  // per strip, as drawn
  std::vector<std::uint32_t> indices_;
  std::vector<std::uint32_t> before_;  // a page as it was
  std::vector<std::uint32_t> piece_;   // that begins at an odd place
  std::vector<std::uint8_t> touched_;
  std::vector<DrawRange> ranges_;
  std::vector<ElementRange> changed_;
};

}  // namespace varifold
