// From the log of a simplification to the numbered mesh and its CollapseSequence.
#pragma once

#include <varifold/simplify/collapse_rounds.h>
#include <varifold/simplify/collapse_sequence.h>
#include <varifold/simplify/placement_collapser.h>

namespace varifold {

/// `log` is the log of collapses of `surface`, which was built from `mesh`. Steps from
/// `step_count` on are ignored: the sequence then ends at a finer base. O(n).
[[nodiscard]] DetailedMesh build_sequence(const TriangleMesh& mesh, const WorkingSurface& surface,
                                          const CollapseLog& log, std::size_t step_count);

/// Adds where the steps move the vertices that stay to a sequence built from the same surface and
/// log. O(steps).
void add_placement(DetailedMesh& detailed, const WorkingSurface& surface,
                   const PlacementLog& placement, std::size_t step_count);

}  // namespace varifold
