// A place among the levels of a ThesisForm.
#pragma once

#include <varifold/models/common/changed_blocks.h>
#include <varifold/models/lodstrips/strip_ranges.h>
#include <varifold/models/lodstrips/strip_slots.h>
#include <varifold/models/lodstrips/thesis_form.h>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

/// Recovery strips, which changes are made in, and draw strips, which are drawn: of the draw strips
/// only those are refreshed that were touched. Allocates in its constructor alone.
class ThesisCursor {
 public:
  /// At the finest level. All three must outlive this.
  ThesisCursor(const ThesisForm& form, const LevelTable& table, const TriangleMesh& attributes);

  [[nodiscard]] std::uint32_t level() const { return level_; }
  /// At most the finest. O(changes and shifted slots between).
  void go_to_level(std::uint32_t level);
  /// Refreshes the draw strips, and sets the indices, ranges and changed indices of the list. The
  /// buffer depends on the level alone, byte for byte. O(touched slots).
  void fill(DrawList& list);
  [[nodiscard]] std::size_t bytes() const;

 private:
  void collapse();
  void split();
  void mark(std::uint32_t strip);

  const ThesisForm& form_;
  const LevelTable& table_;
  std::uint32_t level_;
  std::uint32_t vertex_count_;
  std::size_t cursor_ = 0;  // of the records: those before it have been done
  StripSlots recovery_;
  std::vector<std::uint32_t> draw_;
  std::vector<std::uint8_t> is_modified_;
  std::vector<std::uint32_t> modified_;  // strips
  StripRanges ranges_;
  ChangedBlocks changed_;
};

}  // namespace varifold
