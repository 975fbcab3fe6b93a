// Proves a model sound, or lists what is not.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/base/result.h>
#include <varifold/mesh/validation.h>
#include <varifold/models/pm/progressive_mesh.h>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace varifold {

struct ModelCheckOptions {
  std::uint32_t all_levels_up_to = 2000;  ///< a model of more levels is checked at a spread of them
  std::uint32_t spread_levels = 32;       ///< how many; the base and the full level are among them
  std::uint32_t distance_levels = 8;      ///< levels whose error is measured anew
  /// Of models that have fronts (models/common/front_model.h): how many. The full one, the base and
  /// the full one again come first, then spheres, planes and views that depend on nothing but their
  /// number. 0: none.
  std::uint32_t fronts = 27;
  int threads = 0;  ///< 0 = all
  Progress progress;
};

struct ModelCheck {
  std::vector<Fault> faults;            ///< notes among them, see Severity
  std::uint32_t levels_checked = 0;     ///< each reached upwards, downwards and from a fresh start
  std::uint32_t distances_checked = 0;  ///< levels whose error was compared with distances
  std::uint32_t fronts_checked = 0;     ///< 0 for models without fronts
  /// Of the fronts of a patch tree together: those that switches of borders collapsed.
  std::uint64_t collapsed_triangles = 0;
};

/// The kind of model that an instance is of.
template <class Instance>
using CheckedModel = std::remove_cvref_t<decltype(std::declval<const Instance&>().model())>;

/// Walks the levels of a uniform model (models/common/uniform_model.h) by instances, up, down and
/// directly, and looks at each level that it visits. Topology is judged on the points of the model:
/// the new vertices of one split are one point, vertices of the base are by position.
///
/// Faults, each with the number of levels that have it and the first of them:
/// - not_identical: the buffers of a level depend on the way to it; where an instance says
///   kOrderDependsOnWay, the triangles in them do, whatever their order
/// - wrong_count: other vertices or triangles than the model promises
/// - wrong_corner: a triangle whose corners (or material) are not the ancestors of those of one of
///   the full mesh, or do not exist
/// - doubled_triangle: one that is drawn more often than the full mesh has it
/// - lost_triangle: one that a level lacks, though its corners have three different ancestors
/// - not_closed: an open level of a closed mesh
/// - euler_changed, components_changed: other than of the full mesh
/// - degenerate_triangle: two corners at one point
/// - new_duplicate_triangle, new_nonmanifold_edge, new_misoriented_edge: more than the full mesh
/// has
/// - flipped_triangle: see flipped_triangles(), against the full mesh; where positions were rounded
///   only triangles that are thicker than that
/// - error_not_monotone: negative, not finite, or rising with the level
/// - error_exceeded: a vertex of the full mesh is farther from the level's surface than its error;
///   looked at where errors are measured. Where positions were rounded, the error of the full level
///   says by how much, and that much may be between the two.
/// Levels of a mesh with poses are looked at in each pose, and their errors also in blends of them;
/// faults have pose_ before their names.
/// Fronts have the same faults, from wrong_count to flipped_triangle, with front_ before their
/// names, and these:
/// - front_not_identical: other triangles than a fresh instance has that is led there, than
/// extract()
///   gives, or, of the full front and the base, than the level has
/// - front_over_budget: more triangles than asked for, and than the base has
/// - front_too_coarse: a triangle of the full mesh is missing that reaches into where a sphere or a
/// plane asks
///   for full detail
/// - front_zero_area: triangles on a line, the full mesh having none and the levels looked at
/// neither
/// - missing_dependency: steps that may collapse before what made the triangles around them
/// Every fifth front of a mesh with poses is looked at in each pose, and where the model has errors
/// of steps (view-dependent meshes), the greatest of those that are collapsed is compared with
/// distances in poses and blends; faults have pose_front_ before their names.
/// Note: coincident_point, points of the model at one position (as by rounding).
///
/// The model must be consistent, as from a build or a decoder: its walks end and its indices are
/// vertices. There is an instance of this for every kind of model. O(n log n) a level.
/// Error: kCancelled.
template <class Instance>
[[nodiscard]] Result<ModelCheck> check_model(
    const std::shared_ptr<const CheckedModel<Instance>>& model,
    const ModelCheckOptions& options = {});

[[nodiscard]] Result<ModelCheck> check_progressive_mesh(
    const std::shared_ptr<const ProgressiveMesh>& model, const ModelCheckOptions& options = {});

}  // namespace varifold
