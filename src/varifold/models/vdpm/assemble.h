// What follows from a sequence: all of a view-dependent mesh but its bounds.
#pragma once

#include <varifold/models/common/step_graph.h>
#include <varifold/models/vdpm/view_dependent_mesh.h>
#include <varifold/simplify/collapse_sequence.h>
#include <varifold/simplify/sequence_history.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// The watch tree: per step the finest of those that it requires, or kNone. O(edges).
[[nodiscard]] std::vector<std::uint32_t> watch_parents(const StepGraph& graph);

/// All of the model but its mesh, its levels and its bounds. `watch_parent`: of the graph. O(n).
[[nodiscard]] ViewDependentMeshData assemble_steps(const DetailedMesh& detailed,
                                                   const SequenceHistory& history,
                                                   const StepGraph& graph,
                                                   std::span<const std::uint32_t> watch_parent);

}  // namespace varifold
