// Which collapses of a sequence must come before which others, whatever else is done or not.
#pragma once

#include <varifold/models/strips/dependencies.h>
#include <varifold/simplify/collapse_sequence.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Per step, the finer steps that its collapse depends on; all of them greater numbers.
class StepGraph {
 public:
  /// One replay of the sequence; docs/algorithms/strip_framework.md proves that the rule is enough.
  /// O(n) expected.
  explicit StepGraph(const DetailedMesh& detailed);

  /// Ascending. Steps that another one of them depends on are left out, nearly always.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t step) const {
    return {edges_.data() + begin_[step], end_[step] - begin_[step]};
  }
  /// All of them in the form of StripFrameworkData::dependencies.
  [[nodiscard]] std::vector<std::uint32_t> packed() const;

 private:
  void reduce(std::uint32_t step, DependencyWalk& walk, std::vector<std::uint32_t>& candidates);
  void wait(std::uint32_t vertex, std::uint32_t step);

  std::vector<std::uint32_t> edges_, begin_, end_;  // filled from the finest step down
  // While it is built.
  struct Waiting {
    std::uint32_t step, next;
  };
  std::vector<Waiting> waiting_;
  std::vector<std::uint32_t> first_waiting_;  // per step
  std::vector<std::uint32_t> step_of_;
};

/// The step that removes each vertex; kNone for those of the base. O(vertices).
[[nodiscard]] std::vector<std::uint32_t> steps_of_vertices(const CollapseSequence& sequence);

}  // namespace varifold
