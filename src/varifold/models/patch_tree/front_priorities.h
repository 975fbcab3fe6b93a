// How much the nodes of a patch tree are wanted split, for a view.
//
// Based on: [Birkholz2007] section 4 (priorities divided by the squared distance, culling).
// Differs: the error in pixels beside the paper's priority; distances to the ball, not to a point;
//   culling is inherited as part of the priority, which is never above that of the parent, so that
//   fronts do not depend on how they are reached.
#pragma once

#include <varifold/models/patch_tree/front_lanes.h>
#include <varifold/models/patch_tree/front_tables.h>
#include <varifold/view/criteria.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

enum class PatchMeasure : std::uint8_t {
  kPixels,       ///< PatchBounds::error as seen from the eye, pixels
  kMeanSquared,  ///< PatchBounds::mean_squared by the squared distance, as in the paper; no unit
  kError,        ///< PatchBounds::error, model units, whatever the view
};

/// The priority of a node is what the criteria say of its bounds, but not above that of its
/// parent. It is not negative and not NaN. With kMeanSquared a view gives the paper's priority, 0
/// for what is outside or turned away by the weights of the view, infinite inside the ball. With
/// kError the places of full detail come first and all other nodes by their errors.
///
/// Plain views (no light; weights of 0 or 1, silhouettes as everything else; no places) are
/// computed for eight nodes at a time; all other criteria one by one, with the same results to the
/// bit where both can.
class FrontPriorities {
 public:
  /// False where nothing differs from the call before, so that all priorities are the same.
  [[nodiscard]] bool set(const RefineCriteria& criteria, PatchMeasure measure);

  /// Of existing nodes, with each its parent; priorities of other nodes may be written, too. There
  /// are FrontTables::no_parent() + 1 of them. 2 ns a node.
  void evaluate(const front_lanes::Nodes& nodes) const;
  /// Of `count` children whose parent has priority `limit`.
  void evaluate_children(const FrontTables& tables, std::uint32_t first, std::uint32_t count,
                         float limit, std::span<float> priorities) const;
  /// One by one, whatever the criteria; what vectors of lanes are compared to.
  [[nodiscard]] float evaluate_singly(const PatchBounds& bounds, float limit) const;

 private:
  RefineCriteria criteria_;
  std::vector<BoxCriterion> boxes_;
  PatchMeasure measure_ = PatchMeasure::kPixels;
  bool is_plain_ = false, is_set_ = false;
  std::uint8_t parts_ = 0;
  front_lanes::Functions functions_ = {};  // where it is plain
  front_lanes::Numbers numbers_;
};

}  // namespace varifold
