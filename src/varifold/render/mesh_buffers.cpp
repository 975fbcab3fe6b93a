#include <varifold/render/mesh_buffers.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace varifold::gl {
namespace {

/// How an attribute lies in memory, by MeshBuffers::Attribute.
struct Layout {
  GLint components;
  GLenum type;
  GLboolean normalized;
  GLsizei stride;
  GLuint offset = 0;
};
constexpr Layout kLayouts[MeshBuffers::kAttributeCount] = {
    {3, GL_FLOAT, GL_FALSE, sizeof(Vec3)},
    {3, GL_FLOAT, GL_FALSE, sizeof(Vec3)},
    {2, GL_FLOAT, GL_FALSE, sizeof(Vec2)},
    {4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Color)},
    {4, GL_UNSIGNED_SHORT, GL_FALSE, sizeof(JointWeights), offsetof(JointWeights, joints)},
    {4, GL_FLOAT, GL_FALSE, sizeof(JointWeights), offsetof(JointWeights, weights)},
};

std::size_t upload(GLuint buffer, std::span<const std::byte> bytes, std::size_t begin,
                   std::size_t end) {
  end = std::min(end, bytes.size());
  if (begin >= end) return 0;
  glNamedBufferSubData(buffer, static_cast<GLintptr>(begin), static_cast<GLsizeiptr>(end - begin),
                       bytes.data() + begin);
  return end - begin;
}

}  // namespace

std::size_t PatchedBuffer::update(std::span<const std::byte> bytes, std::size_t element_size,
                                  std::span<const ElementRange> changed) {
  if (bytes.size() > capacity_) {
    // The first upload is exact: most meshes never change size. After that, room to grow.
    capacity_ = capacity_ == 0 ? bytes.size() : bytes.size() + bytes.size() / 2;
    used_ = 0;
    buffer_ = make_buffer();
    glNamedBufferStorage(buffer_.name(), static_cast<GLsizeiptr>(capacity_), nullptr,
                         GL_DYNAMIC_STORAGE_BIT);
  }
  std::size_t uploaded = 0;
  for (const ElementRange& range : changed) {
    const std::size_t begin = range.first * element_size;
    const std::size_t end = begin + range.count * element_size;
    uploaded += upload(buffer_.name(), bytes, begin, std::min(end, used_));
  }
  uploaded += upload(buffer_.name(), bytes, used_, bytes.size());
  used_ = bytes.size();
  return uploaded;
}

void MeshBuffers::connect(Attribute attribute, bool present) {
  present_[attribute] = present;
  const GLuint array = vertex_array_.name();
  if (!present) return glDisableVertexArrayAttrib(array, attribute);
  const Layout& layout = kLayouts[attribute];
  const GLuint source = std::min<GLuint>(attribute, kJoints);
  glVertexArrayVertexBuffer(array, attribute, attributes_[source].name(), 0, layout.stride);
  if (attribute == kJoints)  // numbers, not parts of one
    glVertexArrayAttribIFormat(array, attribute, layout.components, layout.type, layout.offset);
  else
    glVertexArrayAttribFormat(array, attribute, layout.components, layout.type, layout.normalized,
                              layout.offset);
  glVertexArrayAttribBinding(array, attribute, attribute);
  glEnableVertexArrayAttrib(array, attribute);
}

Result<std::size_t> MeshBuffers::update(const DrawList& list) {
  if (!vertex_array_) vertex_array_ = make_vertex_array();
  const std::span<const std::byte> sources[kJointWeights] = {
      std::as_bytes(list.positions), std::as_bytes(list.normals), std::as_bytes(list.texcoords),
      std::as_bytes(list.colors), std::as_bytes(list.skin)};
  std::size_t uploaded = 0;
  for (GLuint i = 0; i < kJointWeights; ++i) {
    const auto stride = static_cast<std::size_t>(kLayouts[i].stride);
    uploaded += attributes_[i].update(sources[i], stride, list.changed_vertices);
    connect(static_cast<Attribute>(i), !sources[i].empty());
  }
  connect(kJointWeights, !list.skin.empty());
  auto posed = poses_.update(list);
  if (!posed) return posed;
  uploaded += *posed;
  uploaded +=
      indices_.update(std::as_bytes(list.indices), sizeof(std::uint32_t), list.changed_indices);
  glVertexArrayElementBuffer(vertex_array_.name(), indices_.name());
  if (auto done = check_errors("uploading a mesh"); !done)
    return tl::unexpected<Error>(std::move(done.error()));
  return uploaded;
}

Result<void> check_list(const DrawList& list) {
  const std::size_t vertices = list.positions.size();
  const auto fits = [&](std::size_t count) { return count == 0 || count == vertices; };
  if (vertices >= kNone) return fail(ErrorKind::kUnsupported, "draw list: too many vertices");
  if (!fits(list.normals.size()) || !fits(list.texcoords.size()) || !fits(list.colors.size()) ||
      !fits(list.skin.size()) ||
      !std::all_of(list.poses.begin(), list.poses.end(), [&](const Pose& pose) {
        return pose.positions.size() == vertices && fits(pose.normals.size());
      }))
    return fail(ErrorKind::kInvalidInput, "draw list: attributes and positions differ in number");
  for (std::size_t i = 0; i < list.ranges.size(); ++i) {
    const DrawRange& range = list.ranges[i];
    const std::uint64_t end = std::uint64_t{range.first_index} + range.index_count;
    if (end > list.indices.size())
      return fail(ErrorKind::kInvalidInput,
                  "draw list: range " + std::to_string(i) + " ends beyond the indices");
  }
  return {};
}

}  // namespace varifold::gl
