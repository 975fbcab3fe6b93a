// Levels of patches: every level has half the patches of the one before, up to one.
//
// Based on: [Birkholz2007] section 3 (figure 2).
// Differs: the levels are states of one greedy merging, halted at each half, in place of a binary
//   tree that is cut afterwards; parts that do not touch are merged by nearness.
#pragma once

#include <varifold/partition/patches.h>
#include <varifold/partition/surface_view.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

struct PatchLevels {
  /// Per level, from the leaves to the roots, and patch of it: its parent, a patch of the next
  /// level, or kNone in the last. Children of a patch are numbered one after the other, in the
  /// order of their parents; a patch may be the only child.
  std::vector<std::vector<std::uint32_t>> parent;

  [[nodiscard]] std::uint32_t level_count() const {
    return static_cast<std::uint32_t>(parent.size());
  }
  [[nodiscard]] std::uint32_t patch_count(std::uint32_t level) const {
    return static_cast<std::uint32_t>(parent[level].size());
  }
};

/// Merges the patches of a partition level by level, each with half as many (rounded up), until
/// there is one, by the metric of make_patches(); discs are preferred, materials and components are
/// merged. No patch has more than kMaxPatchExcess times the mean of the triangles of a patch of its
/// level, where that can be. Numbers the patches of `partition` anew. Nothing for an empty one. The
/// same result for any number of threads. O(n), most of it to find the borders.
[[nodiscard]] PatchLevels make_levels(const SurfaceView& surface, Partition& partition,
                                      int threads = 0);
/// The same where the links of the surface are known.
[[nodiscard]] PatchLevels make_levels(const SurfaceView& surface, const EdgeLinks& links,
                                      Partition& partition, int threads);

/// The patches that share at least one point with each patch, in rows.
struct PatchNeighbors {
  std::vector<std::uint32_t> first;      ///< per patch, and one more
  std::vector<std::uint32_t> neighbors;  ///< those of a patch ascend, without itself

  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t patch) const {
    return {neighbors.data() + first[patch], neighbors.data() + first[patch + 1]};
  }
};

/// `points` are the points of the triangles of each patch in rows, from `first[patch]` on, in any
/// order and as often as one likes, each below `point_count`. O(n), and a sort of what meets at
/// borders.
[[nodiscard]] PatchNeighbors patch_neighbors(std::span<const std::uint32_t> points,
                                             std::span<const std::uint32_t> first,
                                             std::uint32_t point_count);

}  // namespace varifold
