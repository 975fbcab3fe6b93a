#include <varifold/render/picture_passes.h>

#include <varifold/render/shaders.h>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <string>

namespace varifold::gl {
namespace {

/// Of the neighbourhood that occludes, as a part of the picture's height.
constexpr float kOcclusionRadius = 0.05f;

}  // namespace

Result<void> PicturePasses::create(Pass& pass, const char* name, std::string_view source,
                                   std::string_view defines) {
  const std::string multiple_defines = std::string(defines) + "#define MULTISAMPLE\n";
  const ShaderStage vertex{GL_VERTEX_SHADER, kScreenVertexShader};
  Result<void> made =
      assign(pass.single, make_program(name, {vertex, {GL_FRAGMENT_SHADER, source, defines}}));
  if (made)
    made = assign(pass.multiple,
                  make_program(name, {vertex, {GL_FRAGMENT_SHADER, source, multiple_defines}}));
  return made;
}

Result<void> PicturePasses::create() {
  screen_triangle_ = make_vertex_array();
  Result<void> made = create(occlusion_, "occlusion", kOcclusionFragmentShader, "");
  if (made) made = create(blur_, "occlusion blur", kOcclusionBlurFragmentShader, "");
  if (made) made = create(resolve_, "resolve", kResolveFragmentShader, "");
  if (made)
    made = create(resolve_occluded_, "resolve", kResolveFragmentShader, "#define OCCLUSION\n");
  return made;
}

void PicturePasses::run(const FrameTargets& targets, const Camera& camera,
                        const PictureOptions& options) const {
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  if (options.ambient_occlusion) run_occlusion(targets, camera);
  run_resolve(targets, options);
}

void PicturePasses::run_occlusion(const FrameTargets& targets, const Camera& camera) const {
  const bool multisample = targets.scene_size.samples > 1;
  const float tangent = std::tan(0.5f * glm::radians(camera.fovy_degrees));
  const Vec2 depth_range(camera.near_distance, camera.far_distance);
  const Program& occlusion = multisample ? occlusion_.multiple : occlusion_.single;
  set_uniform(occlusion, "depths", 0);
  set_uniform(occlusion, "depth_range", depth_range);
  set_uniform(occlusion, "half_tangent", Vec2(tangent * camera.aspect(), tangent));
  set_uniform(occlusion, "radius", kOcclusionRadius);
  glBindTextureUnit(0, targets.scene_depth.name());
  draw(occlusion, targets.raw_occlusion_target, targets.scene_size);

  const Program& blur = multisample ? blur_.multiple : blur_.single;
  set_uniform(blur, "depths", 0);
  set_uniform(blur, "occlusion", 1);
  set_uniform(blur, "depth_range", depth_range);
  glBindTextureUnit(1, targets.raw_occlusion.name());
  draw(blur, targets.blurred_occlusion_target, targets.scene_size);
}

void PicturePasses::run_resolve(const FrameTargets& targets, const PictureOptions& options) const {
  const Pass& pass = options.ambient_occlusion ? resolve_occluded_ : resolve_;
  const Program& program = targets.scene_size.samples > 1 ? pass.multiple : pass.single;
  set_uniform(program, "scene", 0);
  set_uniform(program, "occlusion", 1);
  // For a texture of one sample the sample number is the mip level 0.
  set_uniform(program, "samples", targets.scene_size.samples);
  set_uniform(program, "supersampling", options.supersampling);
  set_uniform(program, "size", Vec2(targets.picture_size.width, targets.picture_size.height));
  set_uniform(program, "background_top", options.background_top);
  set_uniform(program, "background_bottom", options.background_bottom);
  glBindTextureUnit(0, targets.scene_color.name());
  if (options.ambient_occlusion) glBindTextureUnit(1, targets.blurred_occlusion.name());
  draw(program, targets.picture, targets.picture_size);
}

void PicturePasses::draw(const Program& program, const Framebuffer& target,
                         const TextureSize& size) const {
  glBindFramebuffer(GL_FRAMEBUFFER, target.name());
  glViewport(0, 0, size.width, size.height);
  glUseProgram(program.name());
  glBindVertexArray(screen_triangle_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace varifold::gl
