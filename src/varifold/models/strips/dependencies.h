// The dependencies of a model as words, and what must hold for them.
#pragma once

#include <varifold/models/common/level_table.h>
#include <varifold/models/common/step_graph.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Those of all steps in the form of StripFrameworkData::dependencies. O(steps).
[[nodiscard]] std::vector<std::uint32_t> packed_dependencies(const StepGraph& graph);

/// The dependencies of single steps.
class DependencyLists {
 public:
  /// Why the words are not StripFrameworkData::dependencies of so many steps, or nothing.
  const char* read(std::span<const std::uint32_t> words, std::uint32_t steps);
  /// Ascending, all finer than the step.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t step) const {
    return {steps_.data() + begin_[step], count_[step]};
  }

 private:
  std::vector<std::uint32_t> steps_, begin_, count_;
};

/// Nothing, or what is wrong with StripFrameworkData::dependencies: each step must have finer ones,
/// ascending, and must depend on all steps whose vertices go to its own. Slots are written right as
/// long as those come first. O(words + steps).
[[nodiscard]] const char* dependency_fault(std::span<const std::uint32_t> words,
                                           const LevelTable& levels);

}  // namespace varifold
