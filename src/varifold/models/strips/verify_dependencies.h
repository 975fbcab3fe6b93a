// Whether the dependencies of a model are all that its fronts need.
#pragma once

#include <varifold/models/strips/strip_framework.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// The steps that do not depend, directly or through others, on all steps that made the triangles
/// around their points what they are when these collapse (docs/algorithms/strip_framework.md), so
/// that fronts may fold or tear there. Ascending; ends when it has kMostStepsLacking. The model
/// must be consistent, as from a build or a decoder, which look at less. Replays the sequence: O(n)
/// expected where the dependencies are those of a build.
[[nodiscard]] std::vector<std::uint32_t> steps_lacking_dependencies(const StripFramework& model);
inline constexpr std::uint32_t kMostStepsLacking = 1000;

}  // namespace varifold
