// The front of a patch tree: which patches are drawn for a view, and which of their borders are
// switched.
//
// Based on: [Birkholz2007] section 4 (synthesis), section 5 (borders).
// Differs: stops at an error in pixels beside a number of triangles; what splitting a node forces
//   is counted before it is done, so that budgets hold; frames begin with the front before, with
//   the same result as from the roots.
#pragma once

#include <varifold/models/common/front_model.h>
#include <varifold/models/patch_tree/front_draws.h>
#include <varifold/models/patch_tree/front_priorities.h>
#include <varifold/models/patch_tree/front_queue.h>
#include <varifold/models/patch_tree/front_set.h>
#include <varifold/models/patch_tree/front_tables.h>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace varifold {

/// Beside AdaptOptions, whose tolerance is in the units of the measure.
struct PatchFrontOptions {
  AdaptOptions limits;
  PatchMeasure measure = PatchMeasure::kPixels;
  std::uint32_t max_splits = kNone;  ///< in a call; merges are not counted
  /// After the call began, no more is split; a few splits are always done. 0: no limit.
  float max_microseconds = 0;
  ResidentChildren resident;
};

/// Why no more nodes were split.
enum class FrontStop : std::uint8_t {
  kTolerance,  ///< all that is asked for is split
  kTriangles,  ///< the next node and what it requires would exceed the budget
  kSplits,     ///< ... the number of splits
  kTime,
};

struct PatchFrontResult {
  /// `splits` and `collapses` are the differences to the front before; `tolerance` is the priority
  /// of the node where a budget stopped.
  FrontStatistics statistics;
  FrontStop stop = FrontStop::kTolerance;
  bool is_over_budget = false;  ///< the roots alone have more triangles than the budget
  /// Nodes that were asked for and not split for want of resident children, of those looked at.
  std::uint32_t not_resident = 0;
};

/// A place in a patch tree. Nodes are wanted split in the order of their priorities
/// (front_queue.h), each with all nodes that it requires, down to the tolerance or to the first
/// that would exceed the budget: so the front is that of a cut through this order, whichever way it
/// is reached, and adapt() and adapt_split_only() lead to the same one. Nodes that are not
/// resident, and those that require them, are left out. Limits on splits and time stop within this
/// order; adapt() then goes on in the next call.
///
/// A front that was never adapted is that of the roots. No allocation once the front was as large
/// as it gets.
class PatchFront {
 public:
  explicit PatchFront(std::shared_ptr<const FrontTables> tables);
  explicit PatchFront(std::shared_ptr<const PatchTree> tree)
      : PatchFront(std::make_shared<const FrontTables>(std::move(tree))) {}

  /// From the front as it is. O(existing nodes) with a small constant, and what changes; next to
  /// nothing where a plain view and the options are those of the call before.
  PatchFrontResult adapt(const RefineCriteria& criteria, const PatchFrontOptions& options);
  /// From the roots, as in the paper. O(split nodes).
  PatchFrontResult adapt_split_only(const RefineCriteria& criteria,
                                    const PatchFrontOptions& options);
  /// To all nodes of a level of the tree, the finest where there are not so many. O(inner nodes).
  void go_to_level(std::uint32_t level);

  /// The patches, and which of their borders are switched.
  [[nodiscard]] const FrontDraws& draws() const { return draws_; }
  [[nodiscard]] const FrontSet& nodes() const { return set_; }
  [[nodiscard]] const FrontTables& tables() const { return *tables_; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Frame;
  /// Where the order of priorities is cut.
  struct Budget {
    std::uint64_t triangles;
    float floor;  ///< nodes with greater priorities only
  };

  [[nodiscard]] bool begin(const RefineCriteria& criteria, const PatchFrontOptions& options);
  void split_wanted(Frame& frame);
  void coarsen(Frame& frame);
  void stop_at_roots(Frame& frame);
  void refine(Frame& frame);
  FrontStop run_queue(Frame& frame, const Budget& budget);
  void split_chain(float floor);
  PatchFrontResult end(const Frame& frame);

  std::shared_ptr<const FrontTables> tables_;
  FrontPriorities priorities_;
  FrontSet set_;
  FrontQueue queue_;
  FrontDraws draws_;
  PatchFrontOptions options_;
  bool is_settled_ = false;  // the last call was stopped neither by splits nor by time
  PatchFrontResult result_;
  float cut_ = 0;  // the priority where the last call stopped
  std::vector<std::uint32_t> found_;
  std::vector<FrontKey> keys_;
};

}  // namespace varifold
