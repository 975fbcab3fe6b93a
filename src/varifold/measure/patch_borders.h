// Private to this folder: what of a patch tree can be proved without looking at fronts.
#pragma once

#include <varifold/measure/check_parts.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <cstdint>

namespace varifold::check {

/// Whether the borders of patches fit in every legal front. Faults, by level:
/// - neighbor_missing: patches that share a point and are no neighbours
/// - survivors_differ: patches that share a point and would move it to different places
/// - wrong_controller: a point moves other than by the one patch on the other side of a border: it
///   is inside its parent's patch, or where three of those meet, or another patch moves it
/// Where there is none, a point on a border is drawn at one place by all patches that have it:
/// that of its survivor, where one of the two parents is coarse, else its own. So a front is the
/// image of a level under a map of points, and has no boundary that the level does not have.
/// O(n log n).
void check_borders(const PatchTree& tree, PlaceFaults& faults);

/// Looks at every border triangle with every set of the neighbours that move its corners. Faults,
/// by node: turned_triangle, turned by 75 degrees or more against the patch's own one; where both
/// have an area.
void check_turns(const PatchTree& tree, PlaceFaults& faults);

/// Faults, by node: outside_ball, a vertex that is not in its patch's ball; outside_cone, a
/// triangle whose normal is not in the patch's cone.
void check_bounds_of_patches(const PatchTree& tree, PlaceFaults& faults);

}  // namespace varifold::check
