// One level of a patch tree: half of the triangles go, by collapses that leave the borders of the
// coarser patches in shape.
//
// Based on: [Birkholz2007] section 3, "LOD Creation"; [GarlandHeckbert1997]; [Kobbelt1998].
// Differs: the borders that count are those of the patches to come; corners of these stay; what a
//   collapse on a border does to mixed fronts is tested before it is done (border_guard.h).
#pragma once

#include <varifold/base/progress.h>
#include <varifold/models/patch_tree/border_guard.h>
#include <varifold/simplify/attribute_field.h>
#include <varifold/simplify/working_surface.h>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace varifold {

/// The triangles of a level in the order of its patches.
struct LevelMesh {
  std::vector<std::uint32_t> faces;       ///< numbers of triangles of the input
  std::vector<std::uint32_t> corners;     ///< three wedges for each
  std::vector<std::uint32_t> first_face;  ///< per patch, and one more
  [[nodiscard]] std::uint32_t patch_count() const {
    return static_cast<std::uint32_t>(first_face.size() - 1);
  }
  [[nodiscard]] std::uint32_t face_count() const {
    return static_cast<std::uint32_t>(faces.size());
  }
};

struct HalvingOptions {
  int threads = 0;  ///< 0 = all; the result does not depend on it
  Progress progress;
  const PoseField* poses = nullptr;  ///< other poses of the surface, where there are some
};

struct HalvingReport {
  std::uint32_t reruns = 0;           ///< because a mixture was found to be unsound
  std::uint32_t locked_points = 0;    ///< for that reason
  std::uint32_t vanished_points = 0;  ///< of components that went as a whole
  bool is_sound = false;              ///< of all mixtures with the level before
  bool cancelled = false;
};

/// Halves one level after the other on one surface.
class LevelHalving {
 public:
  /// `attributes` may be empty. Both outlive this.
  LevelHalving(WorkingSurface& surface, AttributeField& attributes, const HalvingOptions& options);

  /// Halves what the surface shows, which is `mesh`: the number of its triangles becomes
  /// `target_faces` or as near above as the rules allow. surface.region_of tells for each face the
  /// patch to come. Afterwards survivor() and guard() speak of this level. O(points).
  HalvingReport halve(const LevelMesh& mesh, std::uint32_t target_faces);

  /// Of each patch of the level before: how many of its triangles are left. O(triangles).
  [[nodiscard]] std::vector<std::uint32_t> count_left(const LevelMesh& mesh) const;
  /// Makes the level before the one that is left, in patches of the parents given: `left` as
  /// counted, `parent` per patch, ascending. O(triangles).
  void shrink(LevelMesh& mesh, std::span<const std::uint32_t> left,
              std::span<const std::uint32_t> parent) const;

  /// Where a wedge of the level before went; itself if it stayed.
  [[nodiscard]] std::uint32_t survivor(std::uint32_t wedge) const { return survivor_[wedge]; }
  /// The points that are left, ascending.
  [[nodiscard]] std::span<const std::uint32_t> live() const { return live_; }
  /// The points that went, ascending, each with the point where it ended up; once for each level.
  [[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>> take_went() {
    return std::exchange(went_, {});
  }
  [[nodiscard]] const BorderGuard& guard() const { return guard_; }

 private:
  void begin_level(const LevelMesh& mesh);
  [[nodiscard]] bool collapse(std::uint32_t target_faces, std::vector<CollapseLogEntry>& log);
  [[nodiscard]] std::uint32_t vanish(std::uint32_t target_faces,
                                     std::vector<CollapseLogEntry>& log);
  void restore(const LevelMesh& mesh, std::span<const CollapseLogEntry> log);
  void find_survivors(std::span<const CollapseLogEntry> log);
  /// Where the corners of a triangle went; false where two of them fell together.
  [[nodiscard]] bool is_left(const LevelMesh& mesh, std::size_t triangle,
                             std::array<std::uint32_t, 3>& corners) const;
  [[nodiscard]] std::uint32_t point_of(std::uint32_t wedge) const {
    return surface_.wedge.has_seams() ? surface_.wedge.point_of[wedge] : wedge;
  }

  WorkingSurface& surface_;
  AttributeField& attributes_;
  HalvingOptions options_;
  BorderGuard guard_;
  bool is_first_ = true;      // level
  float area_per_point_ = 0;  // of the level
  std::vector<std::uint32_t> survivor_;
  std::vector<std::uint32_t> live_;  // points, ascending
  std::vector<std::pair<std::uint32_t, std::uint32_t>> went_;
};

}  // namespace varifold
