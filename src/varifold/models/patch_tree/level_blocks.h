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
  std::span<const std::uint32_t> first_face;   ///< per patch, and one more
  std::span<const std::uint32_t> parent;       ///< per patch; empty where there is no next level
  std::span<const std::uint32_t> material_of;  ///< per triangle of the input, or empty
  const WorkingSurface& surface;
  const LevelHalving* halving;  ///< null where there is no next level
};

/// Lays out the blocks of levels, from the finest on.
class BlockLayout {
 public:
  BlockLayout(std::uint32_t wedge_count, int threads) : threads_(threads), local_(wedge_count, 0) {}

  /// Lays out a level; `finer`, the one before or null, learns where its survivors stand. Vertices
  /// that only those need are added. O(triangles).
  [[nodiscard]] LevelBlocks lay_out(const FinishedLevel& level, LevelBlocks* finer,
                                    std::span<const std::uint32_t> first_child);

 private:
  struct Triangle {
    std::uint32_t material;
    bool is_border;
    std::uint32_t face;  // of the level
  };
  void lay_out_patch(const FinishedLevel& level, std::uint32_t patch, LevelBlocks& out);
  void sort_triangles(const FinishedLevel& level, std::uint32_t patch);
  void number_vertices(const FinishedLevel& level, std::uint32_t patch, LevelBlocks& out);
  void place_survivors(const FinishedLevel& level, LevelBlocks& finer, std::uint32_t first,
                       std::uint32_t last, LevelBlocks& out);
  std::uint32_t add_vertex(const FinishedLevel& level, std::uint32_t wedge, LevelBlocks& out);
  [[nodiscard]] bool is_known(std::uint32_t wedge) const { return local_[wedge] >= base_; }

  [[maybe_unused]] int threads_;
  // Per wedge: base_ and its number in the present patch. base_ grows from patch to patch.
  std::vector<std::uint64_t> local_;
  std::uint64_t base_ = 1, count_ = 0;
  std::vector<Triangle> triangles_;
};

}  // namespace varifold
