// How much the nodes of a patch tree are wanted split, for a view.
//
// Based on: [Birkholz2007] section 4 (priorities divided by the squared distance, culling).
// Differs: the error in pixels beside the paper's priority; distances to the ball, not to a point;
//   culling is inherited as part of the priority, which is never above that of the parent, so that
//   fronts do not depend on how they are reached.
#pragma once

#include <varifold/models/patch_tree/front_tables.h>
#include <varifold/view/criteria.h>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

enum class PatchMeasure : std::uint8_t {
  kPixels,       ///< PatchBounds::error as seen from the eye, pixels
  kMeanSquared,  ///< PatchBounds::mean_squared by the squared distance, as in the paper; no unit
};

/// The priority of a node is what the criteria say of its bounds, but not above that of its
/// parent. It is not negative and not NaN. With kMeanSquared a view gives the paper's priority, 0
/// for what is outside or turned away by the weights of the view, infinite inside the ball.
///
/// Plain views (no light; weights of 0 or 1, silhouettes as everything else; no places) are
/// computed for eight nodes at a time; all other criteria one by one, with the same results to the
/// bit where both can.
class FrontPriorities {
 public:
  /// What a plain view asks of its lanes.
  struct Numbers {
    float eye_x = 0, eye_y = 0, eye_z = 0, focal = 0, near_distance = 0;
    std::array<std::array<float, 4>, Frustum::kSideCount> planes = {};
    bool operator==(const Numbers&) const = default;
  };

  /// False where nothing differs from the call before, so that all priorities are the same.
  [[nodiscard]] bool set(const RefineCriteria& criteria, PatchMeasure measure);

  /// Of all nodes of `exists`, a set with every node's parent; priorities of other nodes may be
  /// written, too. `priorities` has FrontTables::no_parent() + 1 elements. 1 ns a node.
  void evaluate(const FrontTables& tables, std::span<const std::uint64_t> exists,
                std::span<float> priorities) const;
  /// Of `count` children whose parent has priority `limit`.
  void evaluate_children(const FrontTables& tables, std::uint32_t first, std::uint32_t count,
                         float limit, std::span<float> priorities) const;
  /// One by one, whatever the criteria; what vectors of lanes are compared to.
  [[nodiscard]] float evaluate_singly(const PatchBounds& bounds, float limit) const;

 private:
  enum Part : std::uint8_t { kMeanSquares = 1, kCulls = 2, kTurns = 4, kPartSets = 8 };

  RefineCriteria criteria_;
  std::vector<BoxCriterion> boxes_;
  PatchMeasure measure_ = PatchMeasure::kPixels;
  bool is_plain_ = false, is_set_ = false;
  std::uint8_t parts_ = 0;
  Numbers numbers_;
};

}  // namespace varifold
