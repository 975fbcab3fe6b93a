// At which levels the triangles of strips are there.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/common/level_table.h>
#include <varifold/strip/triangle_strips.h>
#include <cstdint>
#include <vector>

namespace varifold {

struct StripLevels {
  /// How many triangles each level adds to the one before, level 0 first. Those that are degenerate
  /// at full detail count nowhere.
  std::vector<std::uint32_t> added;
  /// Per slot, the coarsest level that has the triangle that begins there; kNone where there is
  /// none.
  std::vector<std::uint32_t> level_of;
  /// The first slots of the triangles that, at some level, have corners at two points only, but
  /// three vertices there: where a seam ends, a triangle may collapse onto both of its sides. They
  /// are gone then, but not degenerate to who looks at vertices. Ascending; seldom any.
  std::vector<std::uint32_t> slivers;
  /// All vertices at one place go at one step and to one place, as in every collapse sequence.
  /// Where they do not, the rest means nothing.
  bool places_stay_whole = true;
};

/// `strips` are those of full detail of the vertices of `mesh`; indices and targets must be valid
/// and positions finite. O(n log n), whatever the tree of targets looks like.
[[nodiscard]] StripLevels strip_levels(const TriangleMesh& mesh, const LevelTable& levels,
                                       const TriangleStrips& strips);

}  // namespace varifold
