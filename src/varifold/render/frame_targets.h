// Private to this folder: the textures that a picture passes through on its way to the display.
#pragma once

#include <varifold/base/result.h>
#include <varifold/render/gl_objects.h>

namespace varifold::gl {

/// The multisampled scene in linear colour (alpha: surface or background) and its depth; a copy of
/// the first samples' depth; and the picture in sRGB.
struct FrameTargets {
  TextureSize scene_size;  ///< supersampled
  TextureSize picture_size;

  Texture scene_color, scene_depth;
  Framebuffer scene;
  Texture first_depth;
  Framebuffer first_depth_target;
  // Only where they are asked for.
  Texture raw_occlusion, blurred_occlusion;
  Framebuffer raw_occlusion_target, blurred_occlusion_target;
  Texture picture_color;
  Framebuffer picture;

  /// Makes everything anew if a size changed. kFailed when memory ends.
  [[nodiscard]] Result<void> resize(const TextureSize& new_scene, const TextureSize& new_picture);
  /// Makes the occlusion buffers if there are none of this size yet.
  [[nodiscard]] Result<void> add_occlusion();
  /// Fills first_depth from scene_depth.
  void copy_first_depth() const;
};

}  // namespace varifold::gl
