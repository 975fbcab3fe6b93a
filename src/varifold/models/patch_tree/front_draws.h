// What is drawn of a front: its nodes, and which of their borders are switched.
//
// Based on: [Birkholz2007] section 5 (borders adapted to the neighbours that are marked).
// Differs: one mask for all children of a node, as they are switched by the neighbours of that
//   (patch_tree.h); kept up by what changes.
#pragma once

#include <varifold/models/patch_tree/front_bits.h>
#include <varifold/models/patch_tree/front_set.h>
#include <varifold/models/patch_tree/front_tables.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// A patch of the front.
struct PatchDraw {
  std::uint32_t node = 0;
  /// Bit i is set where neighbour i of the node's parent is not split: vertices that it controls
  /// are drawn as their survivors. 0 for roots.
  std::uint32_t mask = 0;
  friend bool operator==(const PatchDraw&, const PatchDraw&) = default;
};

/// The draws of a set of split nodes, in slots that draws keep as long as they can. The order of
/// the slots depends on what came before, the set of draws does not. 4 bytes a node and 5 an inner
/// node; allocates in the constructor, and where a front is greater than any before.
class FrontDraws {
 public:
  explicit FrontDraws(const FrontTables& tables);

  /// Follows a set, and has it forget its changes: it is the only one that does. O(neighbours +
  /// children) for each node that is now split and was not, or the other way round.
  void follow(FrontSet& set);

  [[nodiscard]] std::span<const PatchDraw> draws() const { return draws_; }
  /// Slots whose draw is another one than before the last follow(), each once; those beyond the
  /// former number of draws among them. Slots from draws().size() on are gone without notice.
  [[nodiscard]] std::span<const std::uint32_t> changed_slots() const { return changed_; }
  /// The mask for the children of a split node; 0 for others.
  [[nodiscard]] std::uint32_t mask_of(std::uint32_t node) const { return masks_[node]; }
  /// Where a node stands in draws(), or kNone where it is not in the front.
  [[nodiscard]] std::uint32_t slot_of(std::uint32_t node) const { return slot_of_[node]; }

  [[nodiscard]] std::uint64_t triangles() const { return triangles_; }
  [[nodiscard]] std::uint64_t vertices() const { return vertices_; }  ///< of all patches together
  /// In the last follow().
  [[nodiscard]] std::uint32_t splits() const { return splits_; }
  [[nodiscard]] std::uint32_t merges() const { return merges_; }

  [[nodiscard]] std::size_t bytes() const;

 private:
  [[nodiscard]] bool is_split(std::uint32_t node) const {
    return node < tables_->inner_count() && front_bits::has(split_, node);
  }
  void find_changed_nodes(const FrontSet& set);
  void change_masks(std::uint32_t node);
  void change_members(std::uint32_t node);
  void add(std::uint32_t node, std::uint32_t mask);
  void remove(std::uint32_t node);
  void fill_holes();
  void touch(std::uint32_t slot) {
    if (touched_[slot] == 0) changed_.push_back(slot);
    touched_[slot] = 1;
  }

  const FrontTables* tables_;
  std::vector<std::uint64_t> split_;    // as follow() saw it
  std::vector<std::uint8_t> is_new_;    // per inner node: it was not split before
  std::vector<std::uint32_t> masks_;    // per inner node
  std::vector<std::uint32_t> slot_of_;  // per node
  std::vector<PatchDraw> draws_;
  std::vector<std::uint8_t> touched_;  // per slot: it is in changed_
  std::vector<std::uint32_t> changed_, holes_, nodes_, switched_;
  std::uint64_t triangles_ = 0, vertices_ = 0;
  std::uint32_t splits_ = 0, merges_ = 0;
};

}  // namespace varifold
