// One place in a scene where a strips framework stands, at a level or a front of its own.
#pragma once

#include <varifold/models/common/front_model.h>
#include <varifold/models/strips/draw_pages.h>
#include <varifold/models/strips/front.h>
#include <varifold/models/strips/strip_framework.h>
#include <varifold/view/criteria.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace varifold {

/// A cursor over the levels and fronts of a model. Owns the strips (4 bytes a slot), the buffer
/// that is drawn (somewhat more) and 9 bytes a step; shares the vertices. The functions but
/// extract() allocate nothing.
class StripFrameworkInstance {
 public:
  /// Begins at level 0. O(size of the model).
  explicit StripFrameworkInstance(std::shared_ptr<const StripFramework> model);

  [[nodiscard]] const StripFramework& model() const { return *model_; }
  /// kNone where the front is that of no level.
  [[nodiscard]] std::uint32_t level() const { return level_; }
  [[nodiscard]] std::uint32_t vertex_count() const { return vertex_count_; }
  [[nodiscard]] std::uint32_t triangle_count() const { return triangle_count_; }
  /// Whether the split of a step is done.
  [[nodiscard]] bool is_split(std::uint32_t step) const { return split_[step] != 0; }

  /// To a level, at most the model's finest, from any level or front. O(records of the steps
  /// between). The buffers depend on the level alone.
  void go_to_level(std::uint32_t level);

  /// To the coarsest front that has the detail that the criteria ask for, within the budget. The
  /// front depends on criteria and options alone, not on the one before. O(steps + dependencies),
  /// and O(records) of the steps that change.
  FrontStatistics adapt(const RefineCriteria& criteria, const AdaptOptions& options = {});
  /// The same for any measure: urgency(step) >= 0, asked once for each step. Pure functions of the
  /// step give fronts that are always the same.
  template <class Urgency>
  FrontStatistics adapt_by(const Urgency& urgency, const AdaptOptions& options = {}) {
    urgencies_.ask(*model_, [&](std::uint32_t step, std::uint32_t) { return urgency(step); });
    return settle(options);
  }

  /// Draw-ready buffers of the present level or front; what changed since the last call of this
  /// function. Valid until the instance changes. O(slots of the pages that changed).
  [[nodiscard]] DrawList draw_list();

  /// The strips as they are, degenerate triangles included; laid out as in the model.
  [[nodiscard]] const std::vector<std::uint32_t>& slots() const { return slots_; }

  /// Memory of the instance alone.
  [[nodiscard]] std::size_t bytes() const;

  /// A copy as a mesh of its own, with materials. Its vertices are the first vertex_count() of a
  /// level, and those that are used, in their order, of other fronts. O(slots).
  [[nodiscard]] TriangleMesh extract() const;

 private:
  FrontStatistics settle(const AdaptOptions& options);
  template <class IsSplit>
  void change(std::uint32_t first, std::uint32_t end, const IsSplit& is_split,
              FrontStatistics& statistics);
  void write(std::uint32_t vertex, std::uint32_t value);

  std::shared_ptr<const StripFramework> model_;
  std::uint32_t level_ = 0;
  std::uint32_t vertex_count_ = 0;
  std::uint32_t triangle_count_ = 0;
  std::vector<std::uint32_t> slots_;
  std::vector<std::uint8_t> split_;  // per step
  StepUrgencies urgencies_;
  DrawPages pages_;
  bool vertices_are_new_ = true;
  ElementRange all_vertices_;
};

}  // namespace varifold
