// Proves a patch tree sound, or lists what is not.
#pragma once

#include <varifold/base/result.h>
#include <varifold/measure/check_model.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <memory>

namespace varifold {

/// Looks at what holds for all fronts, then at all levels, and at fronts: half of those of
/// `options` by splitting nodes at random, along chains and alone, half by spheres, planes and
/// views with budgets. Topology is judged on positions, against the finest level.
///
/// Faults of the tree, by level or patch:
/// - neighbor_missing, survivors_differ, wrong_controller: where there is none of these, no legal
///   front has a crack (measure/patch_borders.h)
/// - turned_triangle: under some set of switches turned by 75 degrees or more
/// - outside_ball, outside_cone: bounds that do not hold what is in the patch
/// Faults of levels and, with front_ before their names, of fronts:
/// - wrong_count: not all triangles of the patches are drawn or collapsed; levels collapse none
/// - open_edge, new_nonmanifold_edge, new_misoriented_edge, new_duplicate_triangle,
///   degenerate_triangle: more than the finest level has
/// - euler_changed: a component with an Euler characteristic that none of the finest level has, or
///   that fewer have; components may be fewer, as small ones vanish
/// - not_identical: a list that draws other triangles than the mesh of the front has
/// - front_over_budget: more triangles than asked for, and than level 0 has
/// - front_illegal: patches that share a vertex and differ by more than one level
/// - error_not_monotone, error_exceeded: as of other models
/// A tree with poses is looked at anew in each pose and, but for turned_triangle and outside_cone,
/// in blends; faults have pose_ before their names. Note: lost_component, levels with fewer
/// components.
///
/// The tree must be consistent, as from a build or a decoder. O(n log n) a front. Error:
/// kCancelled.
[[nodiscard]] Result<ModelCheck> check_patch_tree(const std::shared_ptr<const PatchTree>& tree,
                                                  const ModelCheckOptions& options = {});

}  // namespace varifold
