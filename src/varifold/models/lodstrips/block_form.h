// The third form of LodStrips: strips built from coarse to fine, in blocks of 64 slots.
//
// Based on: [Ramos2008] chapters 4 and 5: strips, changes of strips per level, one element buffer.
// Differs: strips come from strip/sequence_strips.h and grow with the level; a change is a byte or
//   two that says where in a block; undoing one needs no stored values.
#pragma once

#include <varifold/base/result.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/common/level_table.h>
#include <varifold/models/common/section_reader.h>
#include <varifold/simplify/collapse_sequence.h>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

/// Blocks of strips of the base, and the changes of every split as bytes; docs/formats/lodstrips.md
/// describes them. All plain data, consistent as from build_block_form() or take().
struct BlockForm {
  std::vector<std::uint32_t> first;       ///< per block, its place in the index buffer
  std::vector<std::uint32_t> range;       ///< per block, where there are several material ranges
  std::uint32_t buffer_size = 0;          ///< indices
  std::vector<std::uint8_t> base_counts;  ///< slots of the base's blocks, which come first
  std::vector<std::uint32_t> base_slots;  ///< their slots
  std::vector<std::uint8_t> step_bytes;   ///< per split; kLongStep: see long_steps
  std::vector<std::uint32_t> long_steps;  ///< level and bytes of longer ones, in turns, ascending
  std::vector<std::uint8_t> records;      ///< of all splits, and kPadding bytes
  std::uint32_t word_bytes = 3;           ///< of the first word of a group in the records

  static constexpr std::uint8_t kLongStep = 255;
  static constexpr std::uint32_t kMaxSlots = 64;
  static constexpr std::uint32_t kPadding = 4;

  [[nodiscard]] std::size_t bytes() const;
  /// The bytes of the split from `level`. O(1), O(log n) for long ones.
  [[nodiscard]] std::uint32_t size_of_step(std::uint32_t level) const {
    return step_bytes[level] != kLongStep ? step_bytes[level] : size_of_long_step(level);
  }

  void append_bytes(std::vector<std::byte>& bytes) const;
  /// Plays all changes once, so that none can leave its block afterwards. kInvalidInput.
  [[nodiscard]] static Result<BlockForm> take(SectionReader& section, const LevelTable& levels,
                                              std::uint32_t material_range_count);

 private:
  [[nodiscard]] std::uint32_t size_of_long_step(std::uint32_t level) const;
};

/// Two replays of the sequence, which must not move vertices. O(n). `word_bytes`, 3 or 4, is the
/// least size of a group's first word; the number of blocks may ask for more.
[[nodiscard]] BlockForm build_block_form(const DetailedMesh& detailed,
                                         std::uint32_t word_bytes = 3);

}  // namespace varifold
