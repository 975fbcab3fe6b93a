// LodStrips as in the thesis: three words a change.
#pragma once

#include <varifold/models/common/level_table.h>
#include <varifold/models/common/section_reader.h>
#include <varifold/strip/triangle_strips.h>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

/// Strips of the full mesh, and the changes that each collapse makes in them. Immutable; indices
/// only, attributes and levels are kept elsewhere.
struct ThesisForm {
  /// One change. Changes stand from the finest level down; inside a level collapses stand before
  /// the removals of the same strip. A level has at least one: where nothing changes, one whose
  /// strip is kNone.
  struct Record {
    std::uint32_t strip;
    std::uint32_t position;  ///< in the strip as it is then; with kLast at the last of a level
    /// 0: the first vertex that the step moves goes to its target here; kMoved + i: the i-th does.
    /// n in (0, kMoved): n removals of type one here, -n of type two (StripSlots::remove()).
    std::int32_t r;
  };
  static constexpr std::uint32_t kLast = 0x80000000u;
  static constexpr std::int32_t kMoved = 0x40000000;

  TriangleStrips strips;
  std::vector<Record> records;

  [[nodiscard]] std::size_t bytes() const;
  void append_bytes(std::vector<std::byte>& bytes) const;
  /// What append_bytes() wrote, checked by replaying all of it: whatever the bytes, levels of what
  /// is returned stay within bounds. Errors: kInvalidInput with the place. O(bytes).
  [[nodiscard]] static Result<ThesisForm> take(SectionReader& section, const LevelTable& table,
                                               std::uint32_t material_range_count);
};

}  // namespace varifold
