// From a numbered mesh to a view-dependent one.
#pragma once

#include <varifold/models/vdpm/step_bounds.h>
#include <varifold/models/vdpm/view_dependent_mesh.h>
#include <varifold/simplify/collapse_sequence.h>

namespace varifold {

/// Any sequence will do, those that move vertices too. An empty model when cancelled.
/// O(n log n): measures the bounds of every step.
[[nodiscard]] ViewDependentMesh build_view_dependent_mesh(const DetailedMesh& detailed,
                                                          const StepBoundsOptions& options = {});

}  // namespace varifold
