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

/// Nothing, or what is wrong with StripFrameworkData::dependencies: each step must have finer ones,
/// ascending, and must depend on all steps whose vertices go to its own. Slots are written right as
/// long as those come first. O(words + steps).
[[nodiscard]] const char* dependency_fault(std::span<const std::uint32_t> words,
                                           const LevelTable& levels);

}  // namespace varifold
