// Private to this folder: from the drawn scene to the finished picture.
#pragma once

#include <varifold/base/result.h>
#include <varifold/render/frame_targets.h>
#include <varifold/render/gl_objects.h>
#include <varifold/render/renderer.h>
#include <varifold/view/camera.h>

namespace varifold::gl {

/// Ambient occlusion where it is asked for, then samples to pixels, background and sRGB.
class PicturePasses {
 public:
  /// Compiles the programs; the context must be current.
  [[nodiscard]] Result<void> create();
  /// Fills targets.picture from targets.scene.
  void run(const FrameTargets& targets, const Camera& camera, const PictureOptions& options) const;

 private:
  /// One program for scenes of one sample a pixel, one for several.
  struct Pass {
    Program single, multiple;
  };
  [[nodiscard]] static Result<void> create(Pass& pass, const char* name, std::string_view source,
                                           std::string_view defines);
  void run_occlusion(const FrameTargets& targets, const Camera& camera) const;
  void run_resolve(const FrameTargets& targets, const PictureOptions& options) const;
  void draw(const Program& program, const Framebuffer& target, const TextureSize& size) const;

  Pass occlusion_, blur_, resolve_, resolve_occluded_;
  VertexArray screen_triangle_;
};

}  // namespace varifold::gl
