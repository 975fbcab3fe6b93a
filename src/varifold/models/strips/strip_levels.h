// At which levels the triangles of strips are there.
#pragma once

#include <varifold/models/common/level_table.h>
#include <varifold/strip/triangle_strips.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// How many triangles of the strips of full detail each level adds to the one before, level 0
/// first; those that are degenerate at full detail count nowhere. All indices and targets must be
/// valid. O(n log n), whatever the tree of targets looks like.
[[nodiscard]] std::vector<std::uint32_t> triangles_added(const LevelTable& levels,
                                                         const TriangleStrips& strips);

}  // namespace varifold
