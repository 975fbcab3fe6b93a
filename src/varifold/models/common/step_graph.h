// Which collapses of a sequence must come before which others, whatever else is done or not.
#pragma once

#include <varifold/models/common/dependency_walk.h>
#include <varifold/simplify/collapse_sequence.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

class SequenceReplay;

/// Per step, the finer steps that its collapse depends on; all of them greater numbers. Turned
/// round: those that must be split before each of these may be.
class StepGraph {
 public:
  /// One replay of the sequence; docs/algorithms/strip_framework.md proves that the rule is enough.
  /// Where collapses move vertices that stay, the star of a step has the triangles around these as
  /// well. O(n) expected.
  explicit StepGraph(const DetailedMesh& detailed);

  /// Ascending. Steps that another one of them depends on are left out, nearly always.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t step) const {
    return {edges_.data() + begin_[step], end_[step] - begin_[step]};
  }
  [[nodiscard]] std::uint32_t step_count() const {
    return static_cast<std::uint32_t>(begin_.size());
  }
  /// Of all steps together.
  [[nodiscard]] std::size_t edge_count() const { return edges_.size(); }

 private:
  void find_candidates(const CollapseSequence& sequence, const SequenceReplay& replay,
                       std::uint32_t step);
  void enter(const CollapseSequence& sequence, const SequenceReplay& replay, std::uint32_t step);
  void take_waiting(std::uint32_t point);
  void reduce(std::uint32_t step, DependencyWalk& walk);
  void wait(std::uint32_t vertex, std::uint32_t step);
  [[nodiscard]] std::uint32_t point_of(std::uint32_t vertex) const;

  std::vector<std::uint32_t> edges_, begin_, end_;  // filled from the finest step down
  // While it is built. A point is the step that removes it, or, where vertices of the base move,
  // the number of steps and the number of the vertex.
  struct Waiting {
    std::uint32_t step, next;
  };
  bool base_waits_ = false;
  std::vector<Waiting> waiting_;
  std::vector<std::uint32_t> first_waiting_;  // per point
  std::vector<std::uint32_t> step_of_;
  std::vector<std::uint32_t> last_change_;  // per triangle
  std::vector<std::uint32_t> slots_, candidates_;
};

/// The step that removes each vertex; kNone for those of the base. O(vertices).
[[nodiscard]] std::vector<std::uint32_t> steps_of_vertices(const CollapseSequence& sequence);

}  // namespace varifold
