// A place among the levels of a GroupedForm.
#pragma once

#include <varifold/models/common/changed_blocks.h>
#include <varifold/models/lodstrips/grouped_form.h>
#include <varifold/models/lodstrips/strip_ranges.h>
#include <varifold/models/lodstrips/strip_slots.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// One element buffer, changed in place and drawn as it is. Allocates in its constructor alone.
class GroupedCursor {
 public:
  /// At the finest level. All three must outlive this.
  GroupedCursor(const GroupedForm& form, const LevelTable& table, const TriangleMesh& attributes);

  [[nodiscard]] std::uint32_t level() const { return level_; }
  /// At most the finest. O(changes and shifted slots between).
  void go_to_level(std::uint32_t level);
  /// Sets the indices, ranges and changed indices of the list. The buffer depends on the level
  /// alone, byte for byte. O(blocks of indices, see ChangedBlocks).
  void fill(DrawList& list);

  /// For glMultiDrawElements: per strip, how many indices to draw (0 where fewer than three), and
  /// where they begin, in bytes. Those of a material range are neighbours.
  [[nodiscard]] std::span<const std::int32_t> counts() const { return counts_; }
  [[nodiscard]] std::span<const std::size_t> offsets() const { return offsets_; }

  [[nodiscard]] std::size_t bytes() const;

 private:
  void collapse();
  void split();
  /// The strip was `before` indices long.
  void resize(std::uint32_t strip, std::uint32_t before);

  const GroupedForm& form_;
  const LevelTable& table_;
  std::uint32_t level_;
  std::uint32_t vertex_count_;
  std::size_t group_ = 0, position_ = 0, moved_ = 0;  // what stands before them has been done
  StripSlots slots_;
  std::vector<std::int32_t> counts_;
  std::vector<std::size_t> offsets_;
  StripRanges ranges_;
  ChangedBlocks changed_;
};

}  // namespace varifold
