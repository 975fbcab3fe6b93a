// The order of collapses: rounds of one octave of cost, in cells that can be drained in parallel.
#pragma once

#include <cstdint>
#include <varifold/base/progress.h>
#include <varifold/simplify/collapser.h>
#include <vector>

namespace varifold {

/// The whole log of a simplification, in the order in which it can be replayed.
struct CollapseLog {
  std::vector<CollapseLogEntry> entries;
  std::vector<std::uint32_t> removed_faces;
  bool cancelled = false;
};

struct RoundOptions {
  std::uint32_t target_faces = 0;       ///< stop after the round that reaches it
  std::uint32_t points_per_cell = 0;    ///< 0 = chosen by the size of the mesh
  int threads = 0;                      ///< 0 = all
  Progress progress;
};

/// Number of cells for a mesh; depends on its size alone, so results do not depend on threads.
[[nodiscard]] std::uint32_t cell_count_for(std::uint32_t points, std::uint32_t points_per_cell);

/// Collapses until nothing legal is left or the target is reached.
///
/// In each round every cell collapses what costs less than the round's limit and lies wholly
/// inside it; the logs are merged by cost; then points with neighbours in other cells follow in one
/// serial pass. Cells merge as points become few, so the coarse levels see one queue.
[[nodiscard]] CollapseLog run_rounds(WorkingSurface& surface, Collapser& collapser,
                                     const RoundOptions& options);

}  // namespace varifold
