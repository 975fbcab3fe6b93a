// LodStrips for the GPU: the changes of a strip in one step together.
#pragma once

#include <varifold/models/common/level_table.h>
#include <varifold/models/common/section_reader.h>
#include <varifold/strip/triangle_strips.h>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

/// Strips of the full mesh, and the changes of each collapse in groups: a strip, how many slots
/// collapse, how many removals of type one and two, and the positions of all of them. Groups stand
/// from the finest level down. Immutable; indices only.
struct GroupedForm {
  /// The number of a strip is in the lower bits.
  static constexpr std::uint32_t kStripMask = 0x3fffffffu;
  static constexpr std::uint32_t kLast = 0x80000000u;      ///< the last group of a level
  static constexpr std::uint32_t kHasMoved = 0x40000000u;  ///< `moved` has an entry for the group
  /// Counts of a group: collapses in the lower bits, then removals of type one and two.
  static constexpr std::uint32_t kCollapseBits = 6, kRemoveBits = 5;

  TriangleStrips strips;
  std::vector<std::uint32_t> groups;  ///< the strip and flags; a level has at least one group
  std::vector<std::uint16_t> counts;  ///< per group
  /// Per group: of its collapses, then of its removals in the order in which they are done. Which
  /// are of type one and which of type two is not told apart here: both are StripSlots::remove().
  std::vector<std::uint16_t> positions;
  /// Per group with kHasMoved: which of the vertices that the step moves collapses; else the first.
  std::vector<std::uint32_t> moved;

  [[nodiscard]] static std::uint32_t collapses(std::uint16_t counts) {
    return counts & ((1u << kCollapseBits) - 1);
  }
  [[nodiscard]] static std::uint32_t removals(std::uint16_t counts) {
    return (counts >> kCollapseBits & ((1u << kRemoveBits) - 1)) +
           (static_cast<std::uint32_t>(counts) >> (kCollapseBits + kRemoveBits));
  }

  [[nodiscard]] std::size_t bytes() const;
  void append_bytes(std::vector<std::byte>& bytes) const;
  /// As ThesisForm::take().
  [[nodiscard]] static Result<GroupedForm> take(SectionReader& section, const LevelTable& table,
                                                std::uint32_t material_range_count);
};

}  // namespace varifold
