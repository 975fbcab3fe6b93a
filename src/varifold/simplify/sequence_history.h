// What every step of a sequence changes, so that it can be walked from the base up.
#pragma once

#include <varifold/simplify/collapse_sequence.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// The changes of all steps at once: about 24 bytes a vertex for the changes and 12 a triangle.
/// Slot 3 t + c is corner c of triangle t.
class SequenceHistory {
 public:
  /// Changes in the order in which SequenceReplay finds them. O(n).
  explicit SequenceHistory(const DetailedMesh& detailed);

  /// From changes that are known, in any order: those of vertex vertices[0] + i are changed[begin]
  /// up to changed[end], these two being changed_begin[i] and changed_begin[i + 1]. O(n).
  SequenceHistory(const CollapseSequence& sequence, std::vector<std::uint32_t> changed,
                  std::vector<std::uint32_t> changed_begin,
                  std::vector<std::uint32_t> first_corners);

  /// The slots that go from target[v] to v where v appears; v is no vertex of the base.
  [[nodiscard]] std::span<const std::uint32_t> changed(std::uint32_t v) const {
    const std::uint32_t i = v - first_vertex_;
    return {changed_.data() + changed_begin_[i], changed_begin_[i + 1] - changed_begin_[i]};
  }
  /// The triangles that the split from `level` adds, ascending.
  [[nodiscard]] std::span<const std::uint32_t> added(std::uint32_t level) const {
    return {added_.data() + added_begin_[level], added_begin_[level + 1] - added_begin_[level]};
  }
  /// The place of a vertex in the tree of targets (target_tree.h); only where the changes were not
  /// known. Slots that come to a vertex are in the order of the places of their vertices at full
  /// detail, and those of one vertex ascending.
  [[nodiscard]] std::uint32_t place_in_tree(std::uint32_t v) const { return places_[v]; }
  /// Per slot, its vertex when its triangle appears: for triangles of the base at level 0.
  [[nodiscard]] const std::vector<std::uint32_t>& first_corners() const { return corners_; }

 private:
  void find_added(const CollapseSequence& sequence);

  std::uint32_t first_vertex_ = 0;
  std::vector<std::uint32_t> changed_, changed_begin_, added_, added_begin_, corners_, places_;
};

}  // namespace varifold
