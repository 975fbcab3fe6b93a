// One place in a scene where a view-dependent mesh stands, at a level or a front of its own.
#pragma once

#include <varifold/models/common/front_model.h>
#include <varifold/models/vdpm/active_surface.h>
#include <varifold/models/vdpm/front_strips.h>
#include <varifold/models/vdpm/geomorph.h>
#include <varifold/models/vdpm/tolerance_search.h>
#include <varifold/models/vdpm/view_dependent_mesh.h>
#include <varifold/models/vdpm/view_front.h>
#include <varifold/view/criteria.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace varifold {

/// A cursor over the levels and fronts of a model. Owns vertex and index buffers of what is active.
/// What is shown depends on level or front alone; where it stands in the buffers, on the way, too.
/// Move it with its pointer only: what it owns refers to the model.
class ViewDependentInstance {
 public:
  /// Draw lists of the same level may have the same vertices and triangles in another order.
  static constexpr bool kOrderDependsOnWay = true;

  /// Begins at level 0. O(size of the model).
  explicit ViewDependentInstance(std::shared_ptr<const ViewDependentMesh> model);

  [[nodiscard]] const ViewDependentMesh& model() const { return *model_; }
  /// kNone where the front is that of no level.
  [[nodiscard]] std::uint32_t level() const { return level_; }
  [[nodiscard]] std::uint32_t vertex_count() const { return surface_.vertex_count(); }
  [[nodiscard]] std::uint32_t triangle_count() const { return surface_.triangle_count(); }
  /// Where morphs are on their way: of what is drawn, as are the counts.
  [[nodiscard]] bool is_split(std::uint32_t step) const { return surface_.is_split(step); }
  [[nodiscard]] const ActiveSurface& surface() const { return surface_; }
  /// Vertices on their way to their places or to their targets.
  [[nodiscard]] std::uint32_t moving_vertices() const { return morphs_.moving_vertices(); }

  /// To a level, at most the model's finest, from any level or front. O(steps between); from a
  /// front, O(steps). Allocates only where buffers never had the size.
  void go_to_level(std::uint32_t level);

  /// To the coarsest front that has the detail that the criteria ask for, within the budget; it
  /// depends on criteria and options alone, not on the front before. The cost goes with what
  /// changes (view_front.h); with a budget the tolerance is searched from that of the last call.
  FrontStatistics adapt(const RefineCriteria& criteria, const AdaptOptions& options = {}) {
    return adapt(criteria, options, {});
  }
  /// The same with limits for a frame; with these the front may lag behind. With morph_frames each
  /// call is a frame of all morphs, also where the camera rests.
  FrontStatistics adapt(const RefineCriteria& criteria, const AdaptOptions& options,
                        const FrontLimits& limits);

  /// Draw-ready buffers; what changed since the last call of this function. Indices name places of
  /// the buffer of active vertices. Valid until the instance changes.
  [[nodiscard]] DrawList draw_list() {
    strips_are_old_ = true;
    return surface_.draw_list();
  }
  /// The same as triangle strips, made anew where triangles have changed (front_strips.h); then all
  /// indices are new. What is drawn should come from one of the two: both take the changes.
  [[nodiscard]] DrawList draw_strips(StripJoin join = StripJoin::kRestart);

  /// Which vertex of the model each slot of the vertex buffer holds; kNone where it is free.
  /// O(vertices of the model).
  [[nodiscard]] std::vector<std::uint32_t> vertices_of_slots() const;

  /// Memory of the instance alone.
  [[nodiscard]] std::size_t bytes() const {
    return surface_.bytes() + front_.bytes() + morphs_.bytes() + strips_.bytes();
  }

  /// A copy as a mesh of its own, with materials: vertices and triangles in the order of the model.
  /// O(size of the model).
  [[nodiscard]] TriangleMesh extract() const { return surface_.extract(); }

 private:
  [[nodiscard]] FrontStatistics fit_budget(const RefineCriteria& criteria,
                                           const AdaptOptions& options, const FrontLimits& limits,
                                           FrontGeomorphs* morphs);

  std::shared_ptr<const ViewDependentMesh> model_;
  ActiveSurface surface_;
  ViewFront front_;
  FrontGeomorphs morphs_;
  ToleranceSearch search_;
  FrontStrips strips_;
  std::uint32_t triangles_in_strips_ = 0;
  bool strips_are_old_ = true;
  std::uint32_t level_ = 0;      // kNone where a front was asked for
  bool front_is_stale_ = false;  // it knows nothing of the level
  bool is_new_ = true;           // neither a front nor a level was asked for
};

}  // namespace varifold
