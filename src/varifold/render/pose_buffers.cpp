#include <varifold/render/pose_buffers.h>

#include <algorithm>
#include <string>

namespace varifold::gl {

namespace {

Texture make_buffer_texture(GLenum format, const Buffer& buffer) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &name);
  glTextureBuffer(name, format, buffer.name());
  return Texture(name);
}

}  // namespace

Result<void> PoseBuffers::make_room(std::size_t poses, std::size_t vertices) {
  if (poses == poses_ && vertices <= capacity_) return {};
  // The first is exact: most meshes never change size. After that, room to grow.
  capacity_ = capacity_ == 0 || poses != poses_ ? vertices : vertices + vertices / 2;
  poses_ = poses;
  used_ = 0;
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  const std::size_t texels = 2 * poses_ * capacity_;
  if (texels > static_cast<std::size_t>(most))
    return fail(ErrorKind::kUnsupported, "poses: " + std::to_string(texels) +
                                             " places and normals; shaders of this device read " +
                                             std::to_string(most));
  buffer_ = make_buffer();
  glNamedBufferStorage(buffer_.name(), static_cast<GLsizeiptr>(texels * sizeof(Vec3)), nullptr,
                       GL_DYNAMIC_STORAGE_BIT);
  glClearNamedBufferData(buffer_.name(), GL_R32F, GL_RED, GL_FLOAT, nullptr);  // to zeros
  texture_ = make_buffer_texture(GL_RGB32F, buffer_);
  return {};
}

Result<std::size_t> PoseBuffers::update(const DrawList& list) {
  if (list.poses.empty()) return 0;
  const std::size_t vertices = list.positions.size();
  if (auto room = make_room(list.poses.size(), vertices); !room)
    return tl::unexpected<Error>(std::move(room.error()));
  std::size_t uploaded = 0;
  const auto upload = [&](std::span<const Vec3> values, std::size_t first, std::size_t begin,
                          std::size_t end) {
    end = std::min(end, values.size());
    if (begin >= end) return;
    const std::size_t bytes = (end - begin) * sizeof(Vec3);
    glNamedBufferSubData(buffer_.name(), static_cast<GLintptr>((first + begin) * sizeof(Vec3)),
                         static_cast<GLsizeiptr>(bytes), values.data() + begin);
    uploaded += bytes;
  };
  for (std::size_t i = 0; i < list.poses.size(); ++i) {
    const Pose& pose = list.poses[i];
    const std::span<const Vec3> normals =
        pose.normals.empty() ? list.normals : std::span<const Vec3>(pose.normals);
    for (std::size_t half = 0; half < 2; ++half) {
      const std::span<const Vec3> values =
          half == 0 ? std::span<const Vec3>(pose.positions) : normals;
      const std::size_t first = (2 * i + half) * capacity_;
      for (const ElementRange& range : list.changed_vertices)
        upload(values, first, range.first, std::min(std::size_t{range.first} + range.count, used_));
      upload(values, first, used_, vertices);
    }
  }
  used_ = vertices;
  return uploaded;
}

void PoseBuffers::set_joints(std::span<const glm::mat4> matrices) {
  if (matrices.size() > joint_capacity_) {
    joint_capacity_ = matrices.size();
    joints_ = make_buffer();
    glNamedBufferStorage(joints_.name(), static_cast<GLsizeiptr>(matrices.size_bytes()), nullptr,
                         GL_DYNAMIC_STORAGE_BIT);
    joint_texture_ = make_buffer_texture(GL_RGBA32F, joints_);
  }
  if (!matrices.empty())
    glNamedBufferSubData(joints_.name(), 0, static_cast<GLsizeiptr>(matrices.size_bytes()),
                         matrices.data());
}

void PoseBuffers::bind(GLuint pose_unit, GLuint joint_unit) const {
  glBindTextureUnit(pose_unit, texture_.name());
  glBindTextureUnit(joint_unit, joint_texture_.name());
}

}  // namespace varifold::gl
