// A place among the levels of a BlockForm.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/common/changed_blocks.h>
#include <varifold/models/common/level_table.h>
#include <varifold/models/lodstrips/block_form.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

namespace blocks {
struct Group;
}

/// How an instance hands its strips over.
enum class StripBuffer : std::uint8_t {
  kInPlace,  ///< blocks where they are, one range each: few indices change from level to level
  kCompact   ///< a second buffer, one range a material: strips without gaps, divided by restarts
};

/// The strips of one level. Begins at level 0; allocates in the constructor only.
class BlockCursor {
 public:
  /// All three must outlive the cursor; `attributes` has the material ranges.
  BlockCursor(const BlockForm& form, const LevelTable& levels, const TriangleMesh& attributes,
              StripBuffer buffer);

  [[nodiscard]] std::uint32_t level() const { return level_; }
  void go_to_level(std::uint32_t level);
  /// Sets the indices, ranges and changed indices of a list. O(blocks that changed), and a byte is
  /// looked at for 16 others; with kCompact O(blocks + level) after a change.
  void fill(DrawList& list);
  /// The index buffer of the blocks; what is in no block is kStripRestart. Depends on the level
  /// alone.
  [[nodiscard]] std::span<const std::uint32_t> slots() const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Place;
  [[nodiscard]] Place place(std::uint32_t block);
  template <std::uint32_t kWordBytes>
  void split_once();
  template <std::uint32_t kWordBytes>
  void collapse_once();
  void undo_group(const blocks::Group& group, const std::uint8_t* at);
  void do_mixed(Place place, const std::uint8_t* at, const std::uint8_t* end, std::uint32_t vertex);
  void undo_mixed(Place place, const std::uint8_t* at, const std::uint8_t* end,
                  std::uint32_t vertex);
  void do_extended(Place place, const std::uint8_t* at, std::uint32_t vertex);
  void undo_extended(Place place, const std::uint8_t* at);
  void split_block(Place place, std::uint32_t slot, bool inside);
  void join_block(Place place, std::uint32_t slot, bool inside);
  void update_ranges();
  void fill_compact();
  [[nodiscard]] std::uint32_t range_of(std::uint32_t block) const {
    return form_.range.empty() ? 0 : form_.range[block];
  }

  static constexpr std::uint32_t kGroupBits = 4;  // blocks of one byte of touched_

  const BlockForm& form_;
  const LevelTable& levels_;
  StripBuffer buffer_;
  std::uint32_t level_ = 0;
  std::uint32_t vertex_count_ = 0;
  std::uint32_t used_blocks_ = 0;
  std::size_t cursor_ = 0;            // in the records
  std::vector<std::uint32_t> slots_;  // with a few more at both ends
  std::vector<std::uint8_t> counts_;  // slots in use, per block
  bool changed_ = true;               // since fill()
  ChangedBlocks changed_slots_;
  std::vector<std::uint8_t> touched_;     // per group of blocks, since fill(); whole words of them
  std::vector<std::uint32_t> materials_;  // per material range
  std::vector<DrawRange> ranges_;
  std::vector<std::uint32_t> compact_;
  std::vector<std::uint32_t> compact_end_;  // per material range, of what has been written
  ElementRange compact_changed_;
};

}  // namespace varifold
