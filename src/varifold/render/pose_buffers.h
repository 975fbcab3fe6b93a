// Private to this folder: what moves the vertices of a draw list, on the graphics card.
#pragma once

#include <varifold/base/result.h>
#include <varifold/render/gl_objects.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <glm/mat4x4.hpp>
#include <span>

namespace varifold::gl {

/// The places and normals of all poses in one buffer that vertex shaders read as a texture, and the
/// matrices of joints in another. Of each pose first the places, then the normals, as many as
/// stride() each; a pose without normals has those at rest.
class PoseBuffers {
 public:
  /// Uploads what changed, as MeshBuffers does. Returns the bytes uploaded; kUnsupported where
  /// shaders of the device cannot read that much.
  [[nodiscard]] Result<std::size_t> update(const DrawList& list);
  /// Uploads matrices, for the draw that follows.
  void set_joints(std::span<const glm::mat4> matrices);

  [[nodiscard]] std::size_t pose_count() const { return poses_; }
  [[nodiscard]] std::size_t stride() const { return capacity_; }
  void bind(GLuint pose_unit, GLuint joint_unit) const;

 private:
  [[nodiscard]] Result<void> make_room(std::size_t poses, std::size_t vertices);

  Buffer buffer_, joints_;
  Texture texture_, joint_texture_;
  std::size_t poses_ = 0;
  std::size_t capacity_ = 0, used_ = 0;  // vertices
  std::size_t joint_capacity_ = 0;
};

}  // namespace varifold::gl
