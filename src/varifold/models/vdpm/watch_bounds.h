// Bounds that hold those of all steps below in a tree.
#pragma once

#include <varifold/models/vdpm/step_bounds.h>
#include <span>
#include <vector>

namespace varifold {

/// How far up the watch tree every step is entered by itself. What is deeper is entered as a ball
/// and a cone of its own subtree, which are a little greater than they need to be.
inline constexpr std::uint32_t kExactWatchDepth = 64;

/// Sets nested_radius, nested_error and nested_angle of bounds whose own parts are set.
/// watch_parent[k] < k or kNone; `centers` of the balls. As tight as two bytes are wherever the
/// tree is less than `exact_depth` deep, which is at least 1. O(steps * min(depth, exact_depth)).
void nest_bounds(std::span<const std::uint32_t> watch_parent, std::span<const Vec3> centers,
                 std::vector<StepBounds>& bounds, std::uint32_t exact_depth = kExactWatchDepth);

}  // namespace varifold
