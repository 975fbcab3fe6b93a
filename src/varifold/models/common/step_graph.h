// Which collapses of a sequence must come before which others, whatever else is done or not.
#pragma once

#include <varifold/simplify/collapse_sequence.h>
#include <varifold/simplify/sequence_history.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Per step, the finer steps that its collapse depends on; all of them greater numbers. Turned
/// round: those that must be split before each of these may be.
class StepGraph {
 public:
  /// docs/algorithms/strip_framework.md proves that the rule is enough. Where collapses move
  /// vertices that stay, the star of a step has the triangles around these as well. O(n) expected;
  /// the same for any number of threads (0 = all), of which two are used.
  StepGraph(const DetailedMesh& detailed, const SequenceHistory& history, int threads = 1);
  explicit StepGraph(const DetailedMesh& detailed)
      : StepGraph(detailed, SequenceHistory(detailed)) {}

  /// Ascending. Steps that another one of them depends on are left out, nearly always.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t step) const {
    return {edges_.data() + begin_[step + 1], begin_[step] - begin_[step + 1]};
  }
  [[nodiscard]] std::uint32_t step_count() const {
    return static_cast<std::uint32_t>(begin_.size() - 1);
  }
  /// Of all steps together.
  [[nodiscard]] std::size_t edge_count() const { return edges_.size(); }

 private:
  // Those of the finest step stand first; the edges of a step end where those of the coarser one
  // before it begin.
  std::vector<std::uint32_t> edges_, begin_;
};

/// The step that removes each vertex; kNone for those of the base. O(vertices).
[[nodiscard]] std::vector<std::uint32_t> steps_of_vertices(const CollapseSequence& sequence);

}  // namespace varifold
