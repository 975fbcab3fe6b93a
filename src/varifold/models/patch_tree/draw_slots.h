// The index buffer of a front: triangles that never change, and slots for those that do.
//
// Based on: [Birkholz2007] section 6 (vertex, normal and triangle arrays in two partitions).
// Differs: the constant partition holds all patches of the tree; the changing one holds the
//   triangles at switched borders alone, of each patch at a place of its own.
#pragma once

#include <varifold/models/patch_tree/front_draws.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace varifold {

/// The buffer begins with the triangles of all patches, written once. Behind it every patch has a
/// slot as large as its border triangles, for these as they were last drawn with switched borders;
/// those that the switches collapse are left out. Patches without switched borders are drawn from
/// the first part alone. 12 bytes a triangle of the tree, and 12 more for those at borders.
class DrawSlots {
 public:
  /// O(triangles of the tree).
  explicit DrawSlots(std::shared_ptr<const PatchTree> tree);

  /// What is drawn differs from the last list at these places of the draws, in any order, also more
  /// than once.
  void mark(std::span<const std::uint32_t> places);

  /// The list of all draws; they differ from those of the last list where marked, or in number.
  /// With `switches` false all masks count as 0, which leaves cracks. Valid until the next call.
  /// O(draws), and O(border triangles) of those that are marked and do not draw what their slot
  /// holds; allocates nothing once there were as many draws.
  [[nodiscard]] DrawList list(std::span<const PatchDraw> draws, bool switches);

  /// The node that each range of the last list is part of.
  [[nodiscard]] std::span<const std::uint32_t> nodes_of_ranges() const { return range_nodes_; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  /// The border triangles of a range of a patch.
  struct Slot {
    std::uint32_t first_index = 0, index_count = 0;
  };
  void write(const PatchDraw& draw);
  void gather_ranges(std::span<const PatchDraw> draws, bool switches);
  void add_range(const DrawRange& range, std::uint32_t node);

  std::shared_ptr<const PatchTree> tree_;
  std::vector<std::uint32_t> indices_;
  std::vector<Slot> slots_;             // per range of the tree
  std::vector<std::uint32_t> written_;  // per node: the mask of what its slots hold; 0: nothing
  std::vector<std::uint8_t> level_of_;  // per node
  std::vector<std::uint32_t> marked_;
  std::vector<std::uint8_t> is_marked_;  // per place
  std::size_t listed_ = 0;               // draws of the last list
  bool switched_ = false;                // and whether it had switches
  std::vector<DrawRange> ranges_;
  std::vector<std::uint32_t> range_nodes_;
  std::vector<ElementRange> changed_;
};

}  // namespace varifold
