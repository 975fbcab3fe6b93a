// The patches of one level while a tree is built: triangles and vertices as they will be stored,
// vertices still named by their wedges.
#pragma once

#include <varifold/models/patch_tree/level_halving.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// What stands in the blocks of a level, patch after patch.
struct LevelBlocks {
  std::vector<PatchOffsets> offsets;         ///< per patch, and one more
  std::vector<std::uint32_t> drawn;          ///< per patch: its first vertices, of its triangles
  std::vector<std::uint32_t> wedges;         ///< per vertex
  std::vector<std::uint32_t> survivors;      ///< per vertex: a wedge of the next level
  std::vector<std::uint16_t> parent_vertex;  ///< per vertex: its survivor in the parent's patch
  std::vector<std::uint32_t> controllers;    ///< per vertex that moves: a patch of the next level
  std::vector<std::uint16_t> corners;
  std::vector<PatchRange> ranges;

  [[nodiscard]] std::uint32_t patch_count() const {
    return static_cast<std::uint32_t>(offsets.size() - 1);
  }
};

/// A level before it is halved, and what halving it did.
struct FinishedLevel {
  const LevelMesh& mesh;                       ///< before
  std::span<const std::uint32_t> parent;       ///< per patch; empty where there is no next level
  std::span<const std::uint32_t> material_of;  ///< per triangle of the input, or empty
  const WorkingSurface& surface;
  const LevelHalving* halving;  ///< null where there is no next level
};

/// Lays out the blocks of a level; `finer`, the level before or null, learns where its survivors
/// stand: `first_child` tells for each patch, and one more, which patches of it are its children.
/// Vertices that only those need are added. The same result for any number of threads.
/// O(triangles).
[[nodiscard]] LevelBlocks lay_out_blocks(const FinishedLevel& level, LevelBlocks* finer,
                                         std::span<const std::uint32_t> first_child, int threads);

}  // namespace varifold
