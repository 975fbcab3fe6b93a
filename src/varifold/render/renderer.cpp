#include <varifold/render/renderer.h>

#include <varifold/render/colors.h>
#include <varifold/render/renderer_impl.h>
#include <varifold/render/shaders.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace varifold {

using gl::MeshBuffers;

namespace {

constexpr std::string_view kWireDefine = "#define WIRE\n";

tl::unexpected<Error> no_frame() { return fail(ErrorKind::kFailed, "renderer: nothing was begun"); }

tl::unexpected<Error> no_mesh() {
  return fail(ErrorKind::kInvalidInput, "renderer: no such mesh on the graphics card");
}

/// Ranges with the same look and primitive go into one multi-draw.
bool same_batch(const DrawRange& a, const DrawRange& b, ColorMode mode) {
  return a.primitive == b.primitive && (mode != ColorMode::kMaterial || a.material == b.material) &&
         (mode != ColorMode::kLevel || a.level == b.level);
}

Vec3 linear_base_color(const DrawList& list, const DrawRange& range, const DrawStyle& style) {
  if (style.color_mode == ColorMode::kLevel)
    return linear_from_srgb(level_color(list.level * range.level));
  if (style.color_mode == ColorMode::kMaterial && range.material < style.material_colors.size())
    return Vec3(style.material_colors[range.material]);
  return linear_from_srgb(style.plain_color);
}

const void* offset_of(std::uint32_t index) {
  const auto offset = std::uintptr_t{index} * sizeof(std::uint32_t);
  // NOLINTNEXTLINE(performance-no-int-to-ptr): an offset into the buffer, says OpenGL
  return reinterpret_cast<const void*>(offset);
}

/// OpenGL pictures start at the bottom row.
template <class T>
void flip_rows(std::vector<T>& values, int height) {
  const std::size_t row = values.size() / static_cast<std::size_t>(height);
  for (std::size_t low = 0, high = static_cast<std::size_t>(height) - 1; low < high; ++low, --high)
    std::swap_ranges(values.begin() + static_cast<std::ptrdiff_t>(low * row),
                     values.begin() + static_cast<std::ptrdiff_t>((low + 1) * row),
                     values.begin() + static_cast<std::ptrdiff_t>(high * row));
}

}  // namespace

void Renderer::Impl::set_camera_uniforms(const gl::Program& program) const {
  const Mat4 view = view_matrix(camera);
  const Mat4 rotation = Mat4(glm::mat3(view));
  gl::set_uniform(program, "eye", camera.eye);
  gl::set_uniform(program, "rotation_projection", projection_matrix(camera) * rotation);
  gl::set_uniform(program, "camera_right", Vec3(glm::row(view, 0)));
  gl::set_uniform(program, "camera_up", Vec3(glm::row(view, 1)));
  gl::set_uniform(program, "camera_back", Vec3(glm::row(view, 2)));
}

void Renderer::Impl::set_style_uniforms(const gl::Program& program, const DrawStyle& style) const {
  // The shader mixes half of it in after shading, so that 2 leaves nothing else.
  float tint = 0;
  if (style.back_faces == BackFaces::kTinted) tint = 0.9f;
  if (style.back_faces == BackFaces::kSignal) tint = 2;
  gl::set_uniform(program, "placement", style.placement);
  gl::set_uniform(program, "back_tint", Vec4(linear_from_srgb(style.back_tint), tint));
  gl::set_uniform(program, "flat_shading", static_cast<int>(style.shading == Shading::kFlat));
  gl::set_uniform(program, "wire_color",
                  Vec4(linear_from_srgb(Vec3(style.wire_color)), style.wire_color.w));
  gl::set_uniform(program, "wire_width",
                  style.wire_width * static_cast<float>(options.supersampling));
}

// A call for each strip: what stands between two restarts.
void Renderer::Impl::draw_strips(const gl::Program& program, const DrawList& list,
                                 const DrawStyle& style) const {
  std::uint32_t strip = 0;
  const bool colors = style.color_mode == ColorMode::kStrip;
  for (const DrawRange& range : list.ranges) {
    const bool is_strip = range.primitive == Primitive::kStrips;
    if (!colors) gl::set_uniform(program, "base_color", linear_base_color(list, range, style));
    const std::uint32_t end = range.first_index + range.index_count;
    for (std::uint32_t first = range.first_index, last = first; first < end; first = last + 1) {
      last = is_strip ? first : end;
      while (last < end && list.indices[last] != kStripRestart) ++last;
      if (last == first) continue;
      if (colors) gl::set_uniform(program, "base_color", linear_from_srgb(strip_color(strip++)));
      glDrawElements(is_strip ? GL_TRIANGLE_STRIP : GL_TRIANGLES,
                     static_cast<GLsizei>(last - first), GL_UNSIGNED_INT, offset_of(first));
    }
  }
}

void Renderer::Impl::draw_ranges(const gl::Program& program, const DrawList& list,
                                 const DrawStyle& style) {
  for (std::size_t i = 0; i < list.ranges.size();) {
    const DrawRange& first = list.ranges[i];
    batch_counts.clear();
    batch_offsets.clear();
    for (; i < list.ranges.size() && same_batch(first, list.ranges[i], style.color_mode); ++i) {
      const DrawRange& range = list.ranges[i];
      batch_counts.push_back(static_cast<GLsizei>(range.index_count));
      batch_offsets.push_back(offset_of(range.first_index));
    }
    gl::set_uniform(program, "base_color", linear_base_color(list, first, style));
    glMultiDrawElements(first.primitive == Primitive::kTriangles ? GL_TRIANGLES : GL_TRIANGLE_STRIP,
                        batch_counts.data(), GL_UNSIGNED_INT, batch_offsets.data(),
                        static_cast<GLsizei>(batch_counts.size()));
  }
}

Result<void> Renderer::Impl::make_programs(const VertexProgram& programs) {
  if (programs.shaded) return {};
  const gl::ShaderStage vertex{GL_VERTEX_SHADER, programs.source, programs.head};
  const gl::ShaderStage geometry{GL_GEOMETRY_SHADER, gl::kWireGeometryShader};
  const gl::ShaderStage fragment{GL_FRAGMENT_SHADER, gl::kMeshFragmentShader};
  const gl::ShaderStage wire{GL_FRAGMENT_SHADER, gl::kMeshFragmentShader, kWireDefine};
  const std::string wire_name = std::string(programs.name) + " in wires";
  auto made = gl::assign(programs.shaded, gl::make_program(programs.name, {vertex, fragment}));
  if (made) made = gl::assign(programs.wire, gl::make_program(wire_name, {vertex, geometry, wire}));
  if (made && in_frame) {
    set_camera_uniforms(programs.shaded);
    set_camera_uniforms(programs.wire);
  }
  return made;
}

void Renderer::Impl::set_raster_state(const DrawStyle& style) const {
  glBindFramebuffer(GL_FRAMEBUFFER, targets.scene.name());
  glViewport(0, 0, targets.scene_size.width, targets.scene_size.height);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_MULTISAMPLE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glFrontFace(GL_CCW);
  glCullFace(GL_BACK);
  if (style.back_faces == BackFaces::kCulled)
    glEnable(GL_CULL_FACE);
  else
    glDisable(GL_CULL_FACE);
}

Result<void> Renderer::Impl::resolve() {
  if (!in_frame) return no_frame();
  if (resolved) return {};
  passes.run(targets, camera, options);
  resolved = true;
  return gl::check_errors("resolving the picture");
}

Result<Renderer> Renderer::create() {
  if (epoxy_gl_version() < 45)
    return fail(ErrorKind::kFailed, "renderer: needs a current context with OpenGL 4.5");
  auto impl = std::make_unique<Impl>();
  auto made = impl->make_programs({impl->mesh_program, impl->wire_program, "meshes",
                                   gl::kMeshVertexShader, gl::kSurfaceOutput});
  if (made) made = impl->passes.create();
  if (!made) return tl::unexpected<Error>(std::move(made.error()));

  GLint color_samples = 1, depth_samples = 1;
  glGetIntegerv(GL_MAX_COLOR_TEXTURE_SAMPLES, &color_samples);
  glGetIntegerv(GL_MAX_DEPTH_TEXTURE_SAMPLES, &depth_samples);
  impl->max_samples = std::max(1, std::min(color_samples, depth_samples));
  return Renderer(std::move(impl));
}

Result<GpuMesh> Renderer::add(const DrawList& list) {
  auto& meshes = impl_->meshes;
  const auto place =
      static_cast<std::size_t>(std::find(meshes.begin(), meshes.end(), nullptr) - meshes.begin());
  if (place == meshes.size()) meshes.emplace_back();
  meshes[place] = std::make_unique<MeshBuffers>();
  const auto mesh = static_cast<GpuMesh>(place);
  if (auto uploaded = update(mesh, list); !uploaded) {
    remove(mesh);
    return tl::unexpected<Error>(std::move(uploaded.error()));
  }
  return mesh;
}

Result<std::size_t> Renderer::update(GpuMesh mesh, const DrawList& list) {
  MeshBuffers* buffers = impl_->find(mesh);
  if (!buffers) return no_mesh();
  if (auto sound = gl::check_list(list); !sound)
    return tl::unexpected<Error>(std::move(sound.error()));
  return buffers->update(list);
}

void Renderer::remove(GpuMesh mesh) {
  if (impl_->find(mesh)) impl_->meshes[static_cast<std::size_t>(mesh)] = nullptr;
}

Result<void> Renderer::begin(const Camera& camera, const PictureOptions& options) {
  impl_->in_frame = false;
  if (!is_usable(camera)) return fail(ErrorKind::kInvalidInput, "renderer: the camera is unusable");
  const int factor = std::clamp(options.supersampling, 1, 8);
  if (camera.width > kMaxFrameSize / factor || camera.height > kMaxFrameSize / factor)
    return fail(ErrorKind::kInvalidInput, "renderer: the picture is larger than " +
                                              std::to_string(kMaxFrameSize) + " pixels a side");
  impl_->camera = camera;
  impl_->options = options;
  impl_->options.supersampling = factor;
  const int samples = std::clamp(options.samples, 1, impl_->max_samples);
  gl::FrameTargets& targets = impl_->targets;
  if (auto done = targets.resize({camera.width * factor, camera.height * factor, samples},
                                 {camera.width, camera.height, 1});
      !done)
    return done;
  if (options.ambient_occlusion)
    if (auto done = targets.add_occlusion(); !done) return done;

  // The depth and colour masks may have been left off by whoever shares the context.
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_SCISSOR_TEST);
  const GLfloat empty[] = {0, 0, 0, 0};
  const GLfloat farthest = 1;
  glClearNamedFramebufferfv(targets.scene.name(), GL_COLOR, 0, empty);
  glClearNamedFramebufferfv(targets.scene.name(), GL_DEPTH, 0, &farthest);
  for (const gl::Program* program :
       {&impl_->mesh_program, &impl_->wire_program, &impl_->posed_program,
        &impl_->posed_wire_program, &impl_->patch_program, &impl_->patch_wire_program,
        &impl_->posed_patch_program, &impl_->posed_patch_wire_program})
    if (*program) impl_->set_camera_uniforms(*program);
  impl_->in_frame = true;
  impl_->resolved = false;
  return gl::check_errors("beginning a picture");
}

Result<void> Renderer::draw(GpuMesh mesh, const DrawList& list, const DrawStyle& style) {
  if (!impl_->in_frame) return no_frame();
  MeshBuffers* buffers = impl_->find(mesh);
  if (!buffers) return no_mesh();
  const bool is_posed = !style.pose.empty();
  if (is_posed)
    if (auto made = impl_->make_posed_programs(); !made) return made;
  impl_->resolved = false;
  impl_->set_raster_state(style);
  glEnable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
  const gl::Program& still = style.wireframe ? impl_->wire_program : impl_->mesh_program;
  const gl::Program& moved = style.wireframe ? impl_->posed_wire_program : impl_->posed_program;
  const gl::Program& program = is_posed ? moved : still;
  impl_->set_style_uniforms(program, style);
  if (is_posed)
    if (auto set = impl_->set_pose(program, buffers->poses(), buffers->has(MeshBuffers::kJoints),
                                   style.pose);
        !set)
      return set;
  const bool colored =
      style.color_mode == ColorMode::kVertexColor && buffers->has(MeshBuffers::kColor);
  gl::set_uniform(program, "use_vertex_color", static_cast<int>(colored));
  glUseProgram(program.name());
  glBindVertexArray(buffers->vertex_array());
  // The value of a normal that is not there: zero asks for facets.
  glVertexAttrib3f(MeshBuffers::kNormal, 0, 0, 0);
  if (style.color_mode == ColorMode::kStrip || style.call_per_strip)
    impl_->draw_strips(program, list, style);
  else
    impl_->draw_ranges(program, list, style);
  glBindVertexArray(0);
  glDisable(GL_CULL_FACE);
  return gl::check_errors("drawing a mesh");
}

void Renderer::finish() { glFinish(); }

Result<Image8> Renderer::read_image() {
  if (auto done = impl_->resolve(); !done) return tl::unexpected<Error>(std::move(done.error()));
  const gl::TextureSize& size = impl_->targets.picture_size;
  Image8 image{size.width, size.height, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(size.width) *
                   static_cast<std::size_t>(size.height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(impl_->targets.picture_color.name(), 0, GL_RGB, GL_UNSIGNED_BYTE,
                    static_cast<GLsizei>(image.rgb.size()), image.rgb.data());
  if (auto done = gl::check_errors("reading the picture"); !done)
    return tl::unexpected<Error>(std::move(done.error()));
  flip_rows(image.rgb, image.height);
  return image;
}

Result<DepthImage> Renderer::read_depth() {
  if (!impl_->in_frame) return no_frame();
  const gl::FrameTargets& targets = impl_->targets;
  targets.copy_first_depth();
  const auto wide = static_cast<std::size_t>(targets.scene_size.width);
  std::vector<float> values(wide * static_cast<std::size_t>(targets.scene_size.height));
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glGetTextureImage(targets.first_depth.name(), 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                    static_cast<GLsizei>(values.size() * sizeof(float)), values.data());
  if (auto done = gl::check_errors("reading the depths"); !done)
    return tl::unexpected<Error>(std::move(done.error()));

  const auto step = static_cast<std::size_t>(impl_->options.supersampling);
  const float near = impl_->camera.near_distance, far = impl_->camera.far_distance;
  DepthImage image{targets.picture_size.width, targets.picture_size.height, {}};
  image.depths.reserve(values.size() / (step * step));
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y)
    for (std::size_t x = 0; x < static_cast<std::size_t>(image.width); ++x) {
      const float depth = values[(y * wide + x) * step];
      image.depths.push_back(depth >= 1 ? std::numeric_limits<float>::infinity()
                                        : near * far / (far - depth * (far - near)));
    }
  flip_rows(image.depths, image.height);
  return image;
}

Result<void> Renderer::present(std::uint32_t framebuffer) {
  if (auto done = impl_->resolve(); !done) return done;
  const gl::TextureSize& size = impl_->targets.picture_size;
  glBlitNamedFramebuffer(impl_->targets.picture.name(), framebuffer, 0, 0, size.width, size.height,
                         0, 0, size.width, size.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  return gl::check_errors("showing the picture");
}

Result<Image8> Renderer::render(const DrawList& list, const Camera& camera, const DrawStyle& style,
                                const PictureOptions& options) {
  const auto mesh = add(list);
  if (!mesh) return tl::unexpected<Error>(mesh.error());
  auto done = begin(camera, options);
  if (done) done = draw(*mesh, list, style);
  remove(*mesh);
  if (!done) return tl::unexpected<Error>(std::move(done.error()));
  return read_image();
}

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

}  // namespace varifold
