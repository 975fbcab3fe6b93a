// What is drawn of a patch tree from frame to frame: how far it jumps, and what blending turns
// over.
#pragma once

#include <varifold/measure/frame_jumps.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <varifold/view/camera.h>
#include <varifold/view/patch_draws.h>
#include <varifold/view/patch_morph.h>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace varifold {

/// Follows the draws of one front, with borders switched and vertices blended as the vertex shader
/// does it. A test, not for every frame: allocates, and takes O(vertices of the tree) memory and
/// O(what is drawn) time.
///
/// Jumps are those of FrameJumps. Its vertices are here the points of the levels: vertices of a
/// level at one place are one point, a point that the coarser level has at the same place, too, is
/// that one, and any other collapses onto the point where its survivors are.
class PatchMotion {
 public:
  /// Covers less than this many pixels: not seen.
  static constexpr double kSeenPixels = 0.05;

  struct Frame {
    FrameJumps::Jumps jumps;
    std::uint64_t triangles = 0;  ///< with an area
    std::uint64_t vertices = 0;   ///< that these name
    std::uint64_t moving = 0;     ///< of them, those between their own place and their target
    /// Triangles whose normals blending turns by more than 90 degrees.
    std::uint64_t turned = 0;
    /// Of these, those that would face the eye if they were not turned, touch the picture with a
    /// corner and cover more than kSeenPixels. Hiding by other parts is not looked at.
    std::uint64_t turned_seen = 0;
  };

  /// O(vertices of the tree).
  explicit PatchMotion(std::shared_ptr<const PatchTree> tree);

  /// The next frame; zero jumps for the first one. The list is one of the tree; with `morph` it has
  /// morphs.
  Frame next(const PatchDrawList& list, const std::optional<PatchMorphRange>& morph,
             const Camera& camera);

 private:
  void read(const PatchDrawList& list, const std::optional<PatchMorphRange>& morph, Frame& frame);
  void count_turned(const PatchDrawList& list, const Camera& camera, Frame& frame) const;

  std::shared_ptr<const PatchTree> tree_;
  std::vector<std::uint32_t> point_of_;  // per vertex of the tree
  std::optional<FrameJumps> jumps_;
  std::vector<Vec3> positions_;          // per vertex, of those that are drawn
  std::vector<std::uint32_t> drawn_in_;  // per vertex: the last frame that drew it
  std::vector<std::uint32_t> indices_;   // three vertices a triangle
  std::uint32_t frame_ = 0;
};

}  // namespace varifold
