// What it costs to draw the patches of the next level instead of those of a level.
#pragma once

#include <varifold/models/patch_tree/assemble.h>
#include <varifold/models/patch_tree/level_errors.h>
#include <varifold/simplify/working_surface.h>

namespace varifold {

/// What replacing the level's patches by their parents costs. The level before it is halved is in
/// the blocks, the surface is that after. O(vertices).
void add_errors(AssembledLevel& level, const LevelErrors& errors, const WorkingSurface& surface,
                int threads);

/// The same for the mean squares alone, by mean value coordinates; vertices that these have no
/// place for count as they did. O(vertices x rounds).
void add_mean_value_errors(AssembledLevel& level, const LevelErrors& errors,
                           const WorkingSurface& surface, int threads);

}  // namespace varifold
