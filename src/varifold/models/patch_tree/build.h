// From a triangle mesh to its patch tree.
//
// Based on: [Birkholz2007] section 3.
// Differs: see patches.h, level_halving.h, border_guard.h, level_errors.h and
//   docs/algorithms/patch_tree.md.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/base/result.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <varifold/simplify/attribute_field.h>
#include <varifold/simplify/pose_use.h>
#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <string>
#include <vector>

namespace varifold {

/// How far a patch is from its children, for the paper's priority.
enum class PatchPriority {
  kClosestPoint,  ///< from each vertex that goes to the nearest place of the coarse surface
  kMeanValue,     ///< to its image by mean value coordinates, as in the paper (mean_value_map.h)
};

struct PatchTreeOptions {
  std::uint32_t triangles_per_patch = 512;  ///< the mean, at every level; at least 1
  bool smooth_borders = true;
  PatchPriority priority = PatchPriority::kClosestPoint;
  AttributeWeights attributes;
  /// Shapes beside that at rest; bounds and errors hold in every blend of all of them, also of
  /// those that do not order the collapses.
  PoseUse poses;
  int threads = 0;  ///< 0 = all; the result does not depend on it
  Progress progress;
};

/// Why there are no coarser levels.
enum class TreeStop {
  kOneRoot,    ///< one patch is left
  kPoorRatio,  ///< a level would have kept too many of its triangles
};

struct PatchTreeReport {
  TreeStop stop = TreeStop::kOneRoot;
  InputFaults faults;
  std::uint32_t non_disc_leaves = 0;
  std::uint32_t reruns = 0;           ///< of levels, because a mixture of patches was unsound
  std::uint32_t locked_points = 0;    ///< for that reason
  std::uint32_t vanished_points = 0;  ///< of components that went as a whole
  std::vector<std::uint32_t> level_triangles;  ///< from the leaves on
  std::vector<std::uint32_t> level_patches;
  /// With several threads errors are measured while levels are laid out.
  double partition_seconds = 0, halving_seconds = 0, layout_seconds = 0, error_seconds = 0;
};

struct PatchTreeBuild {
  PatchTree tree;
  PatchTreeReport report;
};

/// Cuts the mesh into patches, merges and halves them level by level, and lays them out.
///
/// The mesh may be anything that simplify() takes. Every front of the tree in which patches that
/// share a vertex differ by one level at most is closed where the mesh is, has its Euler
/// characteristic and no triangle that a switch turned. Errors: kInvalidInput, kCancelled.
/// O(n log n).
[[nodiscard]] Result<PatchTreeBuild> build_patch_tree(const TriangleMesh& mesh,
                                                      const PatchTreeOptions& options = {});

}  // namespace varifold
