// What the command line and the checks ask of a model whose levels may differ from place to place:
// one concept that every such model satisfies.
#pragma once

#include <varifold/base/math.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/criteria.h>
#include <varifold/view/draw_list.h>
#include <concepts>
#include <cstdint>

namespace varifold {

struct AdaptOptions {
  /// A step is split where its urgency is greater: pixels, for criteria of a view. At least 0.
  float tolerance = 1;
  /// At most so many triangles, unless the base has more: the tolerance is raised as far as that
  /// needs. Collapsed steps of equal urgency stay together, so it may be fewer than could be.
  std::uint32_t max_triangles = kNone;
};

/// What adapt() did and where that led.
struct FrontStatistics {
  std::uint32_t splits = 0, collapses = 0;  ///< done to get here
  /// Of all steps that are split, those nobody asked for; of those split in this call, where a
  /// model looks only at what changes.
  std::uint32_t forced_splits = 0;
  std::uint32_t vertices = 0, triangles = 0;
  float tolerance = 0;        ///< that of the options, or what the budget made of it
  std::uint32_t tests = 0;    ///< questions asked of steps, where a model counts them
  std::uint32_t waiting = 0;  ///< steps that wait for the next call because of a limit, ...
  std::uint32_t refused = 0;  ///< ... of these, for want of triangles in the budget
};

/// A cursor over the fronts of a model. adapt() leads to the front that the criteria ask for:
/// where nothing is asked it is level 0, and full detail wherever a sphere or a plane asks for
/// that. What is drawn, as a set of triangles, depends on criteria and options alone, not on the
/// front before.
template <class I>
concept FrontInstance = requires(I& instance, const I& constant, const RefineCriteria& criteria,
                                 const AdaptOptions& options) {
  { instance.adapt(criteria, options) } -> std::same_as<FrontStatistics>;
  { instance.draw_list() } -> std::same_as<DrawList>;
  { constant.extract() } -> std::same_as<TriangleMesh>;
};

}  // namespace varifold
