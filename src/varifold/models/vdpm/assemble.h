// What follows from a sequence: all of a view-dependent mesh but its bounds.
#pragma once

#include <varifold/models/common/step_graph.h>
#include <varifold/models/vdpm/view_dependent_mesh.h>
#include <varifold/simplify/collapse_sequence.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// The watch tree: per step the finest of those that it requires, or kNone. O(edges).
[[nodiscard]] std::vector<std::uint32_t> watch_parents(const StepGraph& graph);

/// The model without bounds. One replay of the sequence; O(n).
[[nodiscard]] ViewDependentMeshData assemble_steps(const DetailedMesh& detailed,
                                                   const StepGraph& graph);

}  // namespace varifold
