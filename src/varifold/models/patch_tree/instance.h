// One place in a scene where a patch tree stands, at a level or a front of its own.
//
// Based on: [Birkholz2007] sections 4 to 6.
// Differs: see front.h and draw_slots.h.
#pragma once

#include <varifold/models/common/front_model.h>
#include <varifold/models/patch_tree/draw_slots.h>
#include <varifold/models/patch_tree/front.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace varifold {

/// A cursor over the levels and fronts of a patch tree; satisfies LeveledInstance and
/// FrontInstance. What is shown depends on level or front alone; where it stands in the buffers, on
/// the way, too.
class PatchTreeInstance {
 public:
  /// Draw lists of the same level may have the same triangles in another order.
  static constexpr bool kOrderDependsOnWay = true;

  /// Begins at level 0. O(size of the model).
  explicit PatchTreeInstance(std::shared_ptr<const PatchTree> model);

  [[nodiscard]] const PatchTree& model() const { return *model_; }
  /// kNone where the front is that of no level.
  [[nodiscard]] std::uint32_t level() const { return level_; }
  /// Of the patches of the front, as they are stored: triangles that switches collapse count, and
  /// vertices that patches share count for each.
  [[nodiscard]] std::uint32_t vertex_count() const {
    return static_cast<std::uint32_t>(front_.draws().vertices());
  }
  [[nodiscard]] std::uint32_t triangle_count() const {
    return static_cast<std::uint32_t>(front_.draws().triangles());
  }
  /// Of these triangles, those that are not drawn because a switch collapses them. O(triangles at
  /// switched borders).
  [[nodiscard]] std::uint32_t collapsed_triangles() const;
  [[nodiscard]] const PatchFront& front() const { return front_; }
  /// Per node. O(nodes).
  [[nodiscard]] std::vector<std::uint8_t> split_flags() const;

  /// To a level, at most the model's finest. O(inner nodes).
  void go_to_level(std::uint32_t level);

  /// To the coarsest front that has the detail that the criteria ask for, within the budget, in
  /// stored triangles; it depends on criteria and options alone (front.h). Counts and budget are
  /// those of stored triangles.
  FrontStatistics adapt(const RefineCriteria& criteria, const AdaptOptions& options = {});
  /// The same with all options of a patch front; `from_roots`: as in the paper, not from the front
  /// before.
  PatchFrontResult adapt(const RefineCriteria& criteria, const PatchFrontOptions& options,
                         bool from_roots);

  /// To a front of least error, whatever the view, with at most so many stored triangles: levels
  /// may differ from place to place. No legal front within the budget has a smaller greatest
  /// PatchBounds::error, which is what the result has as tolerance, and so none of whole levels
  /// has; where all nodes fit, it is the finest level. The roots where even those are more.
  PatchFrontResult go_to_triangles(std::uint32_t max_triangles);

  /// Without switches borders do not fit where levels meet: to show what they are for.
  void set_switches(bool switches);

  /// Indices of vertices of all patches (draw_slots.h); what changed since the last call of this
  /// function. Valid until the next. O(patches of the front), and O(border triangles) of those that
  /// changed; allocates nothing once a front had as many patches.
  [[nodiscard]] DrawList draw_list() { return slots_.list(front_.draws().draws(), switches_); }
  /// The node that each range of the last list is part of.
  [[nodiscard]] std::span<const std::uint32_t> nodes_of_ranges() const {
    return slots_.nodes_of_ranges();
  }

  /// Memory of the instance alone, tables that fronts may share included.
  [[nodiscard]] std::size_t bytes() const {
    return front_.bytes() + front_.tables().bytes() + slots_.bytes();
  }

  /// A copy as a mesh of its own, with materials; vertices of equal attributes are one, collapsed
  /// triangles are left out. O(size of the model).
  [[nodiscard]] TriangleMesh extract() const;

 private:
  std::shared_ptr<const PatchTree> model_;
  PatchFront front_;
  DrawSlots slots_;
  std::uint32_t level_ = 0;
  bool switches_ = true;
};

}  // namespace varifold
