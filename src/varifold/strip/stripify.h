// Making triangle strips of a mesh.
#pragma once

#include <varifold/strip/triangle_strips.h>
#include <cstdint>

namespace varifold {

enum class StripMethod {
  kLengthFirst,  ///< as few indices as possible
  kCacheAware,   ///< few misses of a vertex cache, at the cost of some indices
};

/// Where a strip of kLengthFirst goes. All but the last two are the rules of STRIPE: go on to the
/// triangle with the fewest neighbours that no strip has yet, and between equals
enum class StripHeuristic {
  kFirst,       ///< to the first one
  kRandom,      ///< to either by chance
  kLookAhead,   ///< to the one whose neighbours have the fewest free ones
  kAlternate,   ///< left and right in turn
  kSequential,  ///< where it costs no swap
  kStraight,    ///< where it costs no swap in any case; starts are tried in all directions
  kRows,        ///< global: the longest rows of alternating turns first, then as kStraight
};

struct StripifyOptions {
  StripMethod method = StripMethod::kLengthFirst;
  StripHeuristic heuristic = StripHeuristic::kRows;
  /// Joins strips whose ends meet, and re-routes strips where that leaves fewer indices. Length
  /// first only.
  bool join_ends = true;
  std::uint64_t seed = 1;         ///< of kRandom
  std::uint32_t cache_size = 16;  ///< entries of the FIFO that kCacheAware works for; > 0
  /// No strip has more indices than this; 0: no limit, else at least 4. For models that change
  /// strips in place, where long ones are slow.
  std::uint32_t max_indices = 0;
};

/// Strips over the vertices of `mesh`, whose indices must be valid. Every triangle with three
/// different corners is in exactly one strip, with its orientation; triangles with two equal
/// corners are left out. Strips do not cross seams, borders, non-manifold edges, edges where
/// orientations clash or materials change (adjacency.h). The result depends on the input alone.
/// O(n log n) at worst, O(n) in practice.
[[nodiscard]] TriangleStrips stripify(const TriangleMesh& mesh,
                                      const StripifyOptions& options = {});

}  // namespace varifold
