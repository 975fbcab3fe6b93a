// Doing the collapses of a sequence once more, one by one, and seeing what each changes.
#pragma once

#include <varifold/simplify/collapse_sequence.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Walks from the full level down. Slots are places in the index buffer: slot 3 t + c is corner c
/// of triangle t. O(1) amortised per changed slot; 24 B per triangle and 8 B per vertex.
class SequenceReplay {
 public:
  explicit SequenceReplay(const DetailedMesh& detailed);

  [[nodiscard]] std::uint32_t level() const { return level_; }
  /// The index buffer: right for the triangles of the present level, and for those already removed
  /// what it held just before their removal.
  [[nodiscard]] const std::vector<std::uint32_t>& corners() const { return corners_; }

  /// One collapse, to level() - 1. Afterwards changed(i) are the slots that went from moved vertex
  /// vertices[level()] + i to its target, and removed() the triangles that vanished.
  void collapse();
  [[nodiscard]] std::span<const std::uint32_t> changed() const { return changed_; }
  [[nodiscard]] std::span<const std::uint32_t> changed(std::uint32_t moved_index) const;
  [[nodiscard]] std::span<const std::uint32_t> removed() const { return removed_; }

  /// The slots of a vertex at the present level, appended to `slots`.
  void slots_of(std::uint32_t vertex, std::vector<std::uint32_t>& slots) const;

 private:
  void move_vertex(std::uint32_t vertex);

  const CollapseSequence& sequence_;
  std::uint32_t level_;
  std::vector<std::uint32_t> corners_;
  std::vector<std::uint32_t> next_;          // per slot, the next slot of the same vertex
  std::vector<std::uint32_t> first_, last_;  // per vertex
  std::vector<std::uint32_t> changed_, changed_end_, removed_;
};

}  // namespace varifold
