#include <varifold/render/frame_targets.h>

namespace varifold::gl {
namespace {

/// A framebuffer that draws colours into a texture.
Framebuffer make_target(const Texture& color) {
  Framebuffer target = make_framebuffer();
  glNamedFramebufferTexture(target.name(), GL_COLOR_ATTACHMENT0, color.name(), 0);
  return target;
}

}  // namespace

Result<void> FrameTargets::resize(const TextureSize& new_scene, const TextureSize& new_picture) {
  if (scene && new_scene == scene_size && new_picture == picture_size) return {};
  *this = {};
  scene_color = make_texture(GL_RGBA16F, new_scene);
  scene_depth = make_texture(GL_DEPTH_COMPONENT32F, new_scene);
  scene = make_target(scene_color);
  glNamedFramebufferTexture(scene.name(), GL_DEPTH_ATTACHMENT, scene_depth.name(), 0);

  first_depth = make_texture(GL_DEPTH_COMPONENT32F, {new_scene.width, new_scene.height, 1});
  first_depth_target = make_framebuffer();
  glNamedFramebufferTexture(first_depth_target.name(), GL_DEPTH_ATTACHMENT, first_depth.name(), 0);
  glNamedFramebufferDrawBuffer(first_depth_target.name(), GL_NONE);
  glNamedFramebufferReadBuffer(first_depth_target.name(), GL_NONE);

  picture_color = make_texture(GL_RGBA8, new_picture);
  picture = make_target(picture_color);

  if (auto done = check_errors("making the picture's buffers"); !done) {
    *this = {};
    return done;
  }
  for (const Framebuffer* target : {&scene, &first_depth_target, &picture})
    if (glCheckNamedFramebufferStatus(target->name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      *this = {};
      return fail(ErrorKind::kFailed, "OpenGL: the driver rejects the picture's buffers");
    }
  scene_size = new_scene;
  picture_size = new_picture;
  return {};
}

Result<void> FrameTargets::add_occlusion() {
  if (raw_occlusion_target) return {};
  const TextureSize size{scene_size.width, scene_size.height, 1};
  raw_occlusion = make_texture(GL_R8, size);
  blurred_occlusion = make_texture(GL_R8, size);
  raw_occlusion_target = make_target(raw_occlusion);
  blurred_occlusion_target = make_target(blurred_occlusion);
  return check_errors("making the occlusion buffers");
}

void FrameTargets::copy_first_depth() const {
  glBlitNamedFramebuffer(scene.name(), first_depth_target.name(), 0, 0, scene_size.width,
                         scene_size.height, 0, 0, scene_size.width, scene_size.height,
                         GL_DEPTH_BUFFER_BIT, GL_NEAREST);
}

}  // namespace varifold::gl
