// The order of collapses: rounds of one octave of cost, in cells that can be drained in parallel.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/simplify/collapser.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// The whole log of a simplification, in the order in which it can be replayed.
struct CollapseLog {
  std::vector<CollapseLogEntry> entries;
  std::vector<std::uint32_t> removed_faces;
  std::size_t queue_bytes = 0;  ///< of all queues, at their peak
  bool cancelled = false;
};

struct RoundOptions {
  std::uint32_t target_faces = 0;  ///< stop after the round that reaches it, ...
  bool exact = false;              ///< ... or after the collapse that does
  bool log_faces = true;           ///< which faces went, not only how many
  /// Stop where a collapse would cost more than so many times what one did halfway to the target;
  /// 0: never.
  float most_cost = 0;
  /// The live points, ascending; empty: they are looked for among all.
  std::span<const std::uint32_t> live;
  int threads = 0;  ///< 0 = all
  Progress progress;
};

/// Collapses until nothing legal is left or the target is reached.
///
/// The surface's ring pools are its cells; their number depends on the mesh alone, so the result
/// does not depend on the number of threads. In each round every cell collapses what costs less
/// than the round's limit and lies wholly inside it; the logs are merged by cost; then points with
/// neighbours in other cells follow in one serial pass. Cells merge as points become few, so the
/// coarse levels see one queue.
[[nodiscard]] CollapseLog run_rounds(WorkingSurface& surface, Collapser& collapser,
                                     const RoundOptions& options);

}  // namespace varifold
