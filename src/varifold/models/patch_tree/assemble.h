// Puts the levels of a tree together, the coarsest first.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/patch_tree/level_blocks.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <varifold/partition/patch_levels.h>
#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// What is kept of a level until all are there. Numbers of patches are those of the level.
struct AssembledLevel {
  LevelBlocks blocks;
  PatchNeighbors neighbors;
  std::vector<std::uint32_t> parent;  ///< per patch; empty where there is no next level
  /// Per patch of the next level, in the units of the surface.
  std::vector<float> error_of_parent, mean_squared_of_parent;
};

/// Per patch of the next level, and one more: its first child.
[[nodiscard]] std::vector<std::uint32_t> first_children(const AssembledLevel& level,
                                                        std::uint32_t parent_count);

/// Numbers the nodes, gathers vertices, and nests bounds and errors. `levels` run from the leaves
/// on. Balls and cones hold the patches in every blend of the mesh at rest, its poses and
/// `samples`. O(size of the tree).
[[nodiscard]] PatchTreeData assemble(const TriangleMesh& mesh, std::span<const Pose> samples,
                                     const WorkingSurface& surface,
                                     std::vector<AssembledLevel> levels, int threads);

/// A tree of one empty patch, for a mesh without triangles.
[[nodiscard]] PatchTreeData empty_tree(const TriangleMesh& mesh);

}  // namespace varifold
