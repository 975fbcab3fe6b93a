// Private to this folder: what a renderer keeps.
#pragma once

#include <varifold/render/frame_targets.h>
#include <varifold/render/gl_objects.h>
#include <varifold/render/mesh_buffers.h>
#include <varifold/render/patch_buffers.h>
#include <varifold/render/picture_passes.h>
#include <varifold/render/renderer.h>
#include <memory>
#include <string_view>
#include <vector>

namespace varifold {

struct Renderer::Impl {
  gl::Program mesh_program, wire_program;
  gl::Program patch_program, patch_wire_program;  // made when the first patches are added
  gl::Program posed_program, posed_wire_program;  // made when the first pose is drawn
  gl::Program posed_patch_program, posed_patch_wire_program;
  gl::PicturePasses passes;
  gl::FrameTargets targets;
  int max_samples = 1;

  std::vector<std::unique_ptr<gl::MeshBuffers>> meshes;    // by GpuMesh; null where free
  std::vector<std::unique_ptr<gl::PatchBuffers>> patches;  // by GpuPatches

  Camera camera;
  PictureOptions options;
  bool in_frame = false;
  bool resolved = false;  // the picture shows all that was drawn

  // One multi-draw; kept, so that frames do not allocate.
  std::vector<GLsizei> batch_counts;
  std::vector<const void*> batch_offsets;

  [[nodiscard]] gl::MeshBuffers* find(GpuMesh mesh) const {
    const auto i = static_cast<std::size_t>(mesh);
    return i < meshes.size() ? meshes[i].get() : nullptr;
  }
  [[nodiscard]] gl::PatchBuffers* find(GpuPatches name) const {
    const auto i = static_cast<std::size_t>(name);
    return i < patches.size() ? patches[i].get() : nullptr;
  }
  void set_camera_uniforms(const gl::Program& program) const;
  void set_style_uniforms(const gl::Program& program, const DrawStyle& style) const;
  /// Where and how triangles fall into the picture.
  void set_raster_state(const DrawStyle& style) const;
  void draw_ranges(const gl::Program& program, const DrawList& list, const DrawStyle& style);
  void draw_strips(const gl::Program& program, const DrawList& list, const DrawStyle& style) const;
  /// A program with its wireframe, by the vertex shader in which alone they differ.
  struct VertexProgram {
    gl::Program& shaded;
    gl::Program& wire;
    std::string_view name, source, head;
  };
  [[nodiscard]] Result<void> make_programs(const VertexProgram& programs);
  [[nodiscard]] Result<void> make_posed_programs();
  [[nodiscard]] Result<void> set_pose(const gl::Program& program, gl::PoseBuffers& poses,
                                      bool has_skin, const DrawPose& pose) const;
  [[nodiscard]] Result<void> make_patch_programs();
  [[nodiscard]] Result<void> make_posed_patch_programs();
  void set_patch_uniforms(const gl::Program& program, gl::PatchBuffers& buffers,
                          const DrawStyle& style, const PatchStyle& patch_style) const;
  [[nodiscard]] Result<void> resolve();
};

}  // namespace varifold
