#include <varifold/render/patch_buffers.h>

#include <algorithm>
#include <string>

namespace varifold::gl {
namespace {

// Commands that stay between two that change: cheaper to send them again than to make another call.
constexpr std::uint32_t kLargestGap = 4;

Buffer make_static_buffer(std::span<const std::byte> bytes) {
  if (bytes.empty()) return {};
  Buffer buffer = make_buffer();
  glNamedBufferStorage(buffer.name(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(), 0);
  return buffer;
}

Result<void> check_size(std::size_t bytes) {
  GLint64 most = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
  if (bytes <= static_cast<std::uint64_t>(most)) return {};
  return fail(ErrorKind::kUnsupported, "patches: " + std::to_string(bytes) +
                                           " bytes in one array; shaders of this device read " +
                                           std::to_string(most));
}

Result<void> check_draw(const PatchDrawList& list, std::size_t i) {
  const PatchDrawCommand& draw = list.draws[i];
  const std::uint64_t end = std::uint64_t{draw.first_index} + draw.index_count;
  if (end > list.indices.size())
    return fail(ErrorKind::kInvalidInput,
                "patches: draw " + std::to_string(i) + " ends beyond the indices");
  if (draw.draw != i || draw.instance_count != 1)
    return fail(ErrorKind::kInvalidInput,
                "patches: draw " + std::to_string(i) + " has another number");
  return {};
}

}  // namespace

Result<std::size_t> PatchBuffers::create(const PatchDrawList& list) {
  const std::span<const std::byte> sources[] = {
      std::as_bytes(list.positions), std::as_bytes(list.normals), std::as_bytes(list.colors),
      std::as_bytes(list.remap),     std::as_bytes(list.morphs),  std::as_bytes(list.skin)};
  static_assert(std::size(sources) == kMaterials);
  std::size_t uploaded = list.indices.size_bytes();
  for (std::size_t i = 0; i < std::size(sources); ++i) {
    if (auto fits = check_size(sources[i].size()); !fits)
      return tl::unexpected<Error>(std::move(fits.error()));
    storages_[i] = make_static_buffer(sources[i]);
    uploaded += sources[i].size();
  }
  DrawList vertices;
  vertices.positions = list.positions;
  vertices.normals = list.normals;
  vertices.poses = list.poses;
  auto posed = poses_.update(vertices);
  if (!posed) return posed;
  uploaded += *posed;
  vertex_count_ = list.positions.size();
  index_count_ = list.indices.size();
  indices_ = make_static_buffer(std::as_bytes(list.indices));
  vertex_array_ = make_vertex_array();
  const GLuint array = vertex_array_.name();
  glVertexArrayElementBuffer(array, indices_.name());
  // Behind the command itself; one for each instance, and a patch is an instance.
  glVertexArrayAttribIFormat(array, 0, 4, GL_UNSIGNED_INT,
                             offsetof(PatchDrawCommand, parent_vertex));
  glVertexArrayAttribFormat(array, 1, 1, GL_FLOAT, GL_FALSE, offsetof(PatchDrawCommand, level));
  for (const GLuint attribute : {0u, 1u}) {
    glVertexArrayAttribBinding(array, attribute, 0);
    glEnableVertexArrayAttrib(array, attribute);
  }
  glVertexArrayBindingDivisor(array, 0, 1);
  auto updated = update(list);
  if (!updated) return updated;
  return uploaded + *updated;
}

Result<std::size_t> PatchBuffers::update(const PatchDrawList& list) {
  if (list.positions.size() != vertex_count_ || list.indices.size() != index_count_)
    return fail(ErrorKind::kInvalidInput, "patches: vertices or indices of another model");
  const auto check = [&](std::size_t draw) { return check_draw(list, draw); };
  for (const std::uint32_t draw : list.changed_draws)
    if (auto sound = check(draw); !sound) return tl::unexpected<Error>(std::move(sound.error()));
  for (std::size_t draw = draw_count_; draw < list.draws.size(); ++draw)
    if (auto sound = check(draw); !sound) return tl::unexpected<Error>(std::move(sound.error()));
  changed_.assign(list.changed_draws.begin(), list.changed_draws.end());
  std::sort(changed_.begin(), changed_.end());
  ranges_.clear();
  for (const std::uint32_t draw : changed_) {
    const std::uint32_t end = ranges_.empty() ? kNone : ranges_.back().first + ranges_.back().count;
    if (ranges_.empty() || draw > end + kLargestGap)
      ranges_.push_back({draw, 1});
    else
      ranges_.back().count = draw + 1 - ranges_.back().first;
  }
  const std::size_t uploaded =
      commands_.update(std::as_bytes(list.draws), sizeof(PatchDrawCommand), ranges_);
  draw_count_ = static_cast<std::uint32_t>(list.draws.size());
  glVertexArrayVertexBuffer(vertex_array_.name(), 0, commands_.name(), 0, sizeof(PatchDrawCommand));
  if (auto done = check_errors("uploading patches"); !done)
    return tl::unexpected<Error>(std::move(done.error()));
  return uploaded;
}

int PatchBuffers::set_materials(std::span<const Vec4> colors) {
  if (!std::equal(colors.begin(), colors.end(), materials_.begin(), materials_.end())) {
    materials_.assign(colors.begin(), colors.end());
    storages_[kMaterials] = make_static_buffer(std::as_bytes(colors));
  }
  return static_cast<int>(materials_.size());
}

void PatchBuffers::draw() const {
  if (draw_count_ == 0 || !indices_) return;
  for (GLuint i = 0; i < kCount; ++i)
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, storages_[i].name());
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.name());
  glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_SHORT, nullptr,
                              static_cast<GLsizei>(draw_count_), sizeof(PatchDrawCommand));
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
  glBindVertexArray(0);
}

Result<void> check_list(const PatchDrawList& list) {
  const std::size_t vertices = list.positions.size();
  const auto fits = [&](std::size_t count) { return count == 0 || count == vertices; };
  if (vertices >= kNone / 3) return fail(ErrorKind::kUnsupported, "patches: too many vertices");
  if (list.remap.size() != vertices || !fits(list.normals.size()) || !fits(list.colors.size()) ||
      !fits(list.texcoords.size()) || !fits(list.morphs.size()) || !fits(list.skin.size()) ||
      !std::all_of(list.poses.begin(), list.poses.end(), [&](const Pose& pose) {
        return pose.positions.size() == vertices && fits(pose.normals.size());
      }))
    return fail(ErrorKind::kInvalidInput, "patches: attributes and positions differ in number");
  for (const std::uint32_t draw : list.changed_draws)
    if (draw >= list.draws.size())
      return fail(ErrorKind::kInvalidInput, "patches: a change beyond the draws");
  return {};
}

}  // namespace varifold::gl
