// The index buffer of a front: triangles that never change, and slots for those that do.
//
// Based on: [Birkholz2007] section 6 (vertex, normal and triangle arrays in two partitions).
// Differs: the constant partition holds all patches of the tree; the changing one holds the
//   triangles of switched borders alone.
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

/// The buffer begins with the triangles of all patches, written once. Behind it every draw of a
/// front whose borders are switched has a slot, as large as any patch needs, for its border
/// triangles; those that the switches collapse are left out. Draws without switched borders are
/// drawn from the first part alone. 12 bytes a triangle of the tree, and the slots.
class DrawSlots {
 public:
  /// O(triangles of the tree).
  explicit DrawSlots(std::shared_ptr<const PatchTree> tree);

  /// Slots that draw others than in the last list, in any order, also more than once.
  void mark(std::span<const std::uint32_t> slots);
  void mark_all() { all_are_new_ = true; }

  /// The list of all draws; `draws` are as large as the marked slots say. With `switches` false all
  /// masks count as 0, which leaves cracks. Valid until the next call. O(marked slots) and a copy
  /// of ranges; allocates nothing once there were as many draws.
  [[nodiscard]] DrawList list(std::span<const PatchDraw> draws, bool switches);

  /// The node that each range of the last list is part of.
  [[nodiscard]] std::span<const std::uint32_t> nodes_of_ranges() const { return range_nodes_; }
  /// What is in use.
  [[nodiscard]] std::size_t bytes() const;

 private:
  void make_room(std::size_t slots);
  void write(std::uint32_t slot, const PatchDraw& draw);
  void add_range(std::uint32_t slot, const DrawRange& range);
  std::uint32_t write_border(std::uint32_t node, std::uint32_t mask, std::size_t first_triangle,
                             std::size_t end_triangle, std::uint32_t to);
  void gather_ranges(std::span<const PatchDraw> draws);

  std::shared_ptr<const PatchTree> tree_;
  std::vector<std::uint32_t> indices_;
  std::uint32_t first_slot_ = 0;       // index where the slots begin
  std::uint32_t slot_indices_ = 0;     // of a slot
  std::uint32_t ranges_per_slot_ = 0;  // at most
  std::size_t most_slots_ = 0;         // that any front needs
  std::size_t room_ = 0;               // slots that there is room for
  std::vector<DrawRange> slot_ranges_;
  std::vector<std::uint32_t> range_counts_;  // per slot
  std::vector<std::uint8_t> is_marked_;      // per slot
  std::vector<std::uint32_t> marked_;
  bool all_are_new_ = true;
  std::size_t listed_ = 0;  // draws of the last list
  std::vector<DrawRange> ranges_;
  std::vector<std::uint32_t> range_nodes_;
  std::vector<ElementRange> changed_;
};

}  // namespace varifold
