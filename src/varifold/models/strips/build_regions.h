// What refinement criteria want to know of every step: where it is, how it is turned, what it
// costs.
#pragma once

#include <varifold/models/common/step_graph.h>
#include <varifold/models/strips/strip_framework.h>
#include <varifold/simplify/collapse_sequence.h>

namespace varifold {

/// Sets radius, cone and error_codes of `data`:
/// - the ball of a step, about its point, holds all triangles that the step changes or removes and
///   the balls of all steps below it in the tree of targets;
/// - its cone holds the normals of the triangles that the step or one below it changes, before and
///   after;
/// - its error bounds the distance of the vertices of the full mesh that it moves from the
///   triangles that it leaves (step_deviations()), and is not below those it depends on.
/// O(n log n) expected.
void measure_regions(const DetailedMesh& detailed, const StepGraph& graph,
                     StripFrameworkData& data);

}  // namespace varifold
