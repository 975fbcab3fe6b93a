// What a renderer does with lists of patches.
#include <varifold/render/colors.h>
#include <varifold/render/patch_shaders.h>
#include <varifold/render/renderer.h>
#include <varifold/render/renderer_impl.h>
#include <varifold/render/shaders.h>
#include <algorithm>
#include <utility>

namespace varifold {

using gl::PatchBuffers;

namespace {

tl::unexpected<Error> no_patches() {
  return fail(ErrorKind::kInvalidInput, "renderer: no such patches on the graphics card");
}

template <class T>
tl::unexpected<Error> error_of(Result<T>& result) {
  return tl::unexpected<Error>(std::move(result.error()));
}

}  // namespace

Result<void> Renderer::Impl::make_patch_programs() {
  GLint blocks = 0;
  glGetIntegerv(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS, &blocks);
  if (blocks < static_cast<GLint>(PatchBuffers::kCount))
    return fail(ErrorKind::kUnsupported,
                "renderer: vertex shaders of this device cannot read the buffers of patches");
  return make_programs(
      {patch_program, patch_wire_program, "patches", gl::kPatchVertexShader, gl::kSurfaceOutput});
}

void Renderer::Impl::set_patch_uniforms(const gl::Program& program, PatchBuffers& buffers,
                                        const DrawStyle& style,
                                        const PatchStyle& patch_style) const {
  ColorMode mode = style.color_mode;
  if (mode == ColorMode::kVertexColor && !buffers.has(PatchBuffers::kColors))
    mode = ColorMode::kPlain;
  if (mode == ColorMode::kStrip) mode = ColorMode::kPatch;
  const bool by_material = mode == ColorMode::kMaterial;
  const auto morph = buffers.has(PatchBuffers::kMorphs) && patch_style.morph
                         ? *patch_style.morph
                         : PatchMorphRange{.band = 0};
  gl::set_uniform(program, "color_mode", static_cast<int>(mode));
  // The vertex shader always says which colour; the fragment shader takes it from there.
  gl::set_uniform(program, "use_vertex_color", 1);
  gl::set_uniform(program, "plain_color", style.plain_color);
  gl::set_uniform(program, "material_count",
                  by_material ? buffers.set_materials(style.material_colors) : 0);
  gl::set_uniform(program, "has_normals", static_cast<int>(buffers.has(PatchBuffers::kNormals)));
  gl::set_uniform(program, "switch_borders", static_cast<int>(patch_style.switch_borders));
  gl::set_uniform(program, "morph_eye", morph.eye);
  gl::set_uniform(program, "morph_near", std::max(morph.near_distance, 1e-30f));
  gl::set_uniform(program, "morph_scale", morph.scale);
  gl::set_uniform(program, "morph_tolerance", std::max(morph.tolerance, 1e-30f));
  gl::set_uniform(program, "morph_band", morph.band);
}

Result<GpuPatches> Renderer::add(const PatchDrawList& list) {
  if (auto made = impl_->make_patch_programs(); !made) return error_of(made);
  if (auto sound = gl::check_list(list); !sound) return error_of(sound);
  auto buffers = std::make_unique<PatchBuffers>();
  if (auto uploaded = buffers->create(list); !uploaded) return error_of(uploaded);
  auto& patches = impl_->patches;
  const auto place = std::find(patches.begin(), patches.end(), nullptr) - patches.begin();
  if (static_cast<std::size_t>(place) == patches.size()) patches.emplace_back();
  patches[static_cast<std::size_t>(place)] = std::move(buffers);
  return static_cast<GpuPatches>(place);
}

Result<std::size_t> Renderer::update(GpuPatches patches, const PatchDrawList& list) {
  PatchBuffers* const buffers = impl_->find(patches);
  if (!buffers) return no_patches();
  if (auto sound = gl::check_list(list); !sound) return error_of(sound);
  return buffers->update(list);
}

void Renderer::remove(GpuPatches patches) {
  if (impl_->find(patches)) impl_->patches[static_cast<std::size_t>(patches)] = nullptr;
}

Result<void> Renderer::draw(GpuPatches patches, const DrawStyle& style,
                            const PatchStyle& patch_style) {
  if (!impl_->in_frame) return fail(ErrorKind::kFailed, "renderer: nothing was begun");
  PatchBuffers* const buffers = impl_->find(patches);
  if (!buffers) return no_patches();
  const bool is_posed = !style.pose.empty();
  if (is_posed)
    if (auto made = impl_->make_posed_patch_programs(); !made) return made;
  impl_->resolved = false;
  impl_->set_raster_state(style);
  // The greatest index of a patch may be what would end a strip.
  glDisable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
  const gl::Program& still = style.wireframe ? impl_->patch_wire_program : impl_->patch_program;
  const gl::Program& moved =
      style.wireframe ? impl_->posed_patch_wire_program : impl_->posed_patch_program;
  const gl::Program& program = is_posed ? moved : still;
  impl_->set_style_uniforms(program, style);
  if (is_posed) {
    const bool has_skin = buffers->has(PatchBuffers::kSkin);
    if (auto set = impl_->set_pose(program, buffers->poses(), has_skin, style.pose); !set)
      return set;
  }
  impl_->set_patch_uniforms(program, *buffers, style, patch_style);
  glUseProgram(program.name());
  buffers->draw();
  glDisable(GL_CULL_FACE);
  return gl::check_errors("drawing patches");
}

Result<Image8> Renderer::render(const PatchItem& item, const Camera& camera,
                                const PictureOptions& options) {
  const auto patches = add(item.list);
  if (!patches) return tl::unexpected<Error>(patches.error());
  auto done = begin(camera, options);
  if (done) done = draw(*patches, item.style, item.patch_style);
  remove(*patches);
  if (!done) return error_of(done);
  return read_image();
}

}  // namespace varifold
