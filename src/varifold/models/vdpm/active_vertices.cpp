#include <varifold/models/vdpm/active_vertices.h>

#include <varifold/mesh/pose_blend.h>
#include <varifold/mesh/vertex_arrays.h>
#include <algorithm>
#include <cmath>

namespace varifold {

ActiveVertices::ActiveVertices(const TriangleMesh& attributes)
    : slot_of_(attributes.vertex_count(), kNone) {
  copy_pose_names(attributes, buffer_);
  for_each_vertex_array(attributes,
                        [&](const auto& values) { is_used_.push_back(!values.empty()); });
  is_used_[0] = true;  // positions
  has_more_ = std::count(is_used_.begin(), is_used_.end(), true) > 1;
}

template <class Visit>
void ActiveVertices::for_each_used(const Visit& visit) {
  std::size_t i = 0;
  for_each_vertex_array(buffer_, [&](auto& values) {
    if (is_used_[i++]) visit(values);
  });
}

void ActiveVertices::reserve(std::uint32_t vertices) {
  reserve_for(buffer_.positions, vertices);
  const std::size_t room = buffer_.positions.capacity();
  for_each_used([&](auto& values) { values.reserve(room); });
  free_.reserve(room);
  dirty_.grow(room);
}

std::uint32_t ActiveVertices::new_slot() {
  const std::uint32_t slot = slots();
  reserve(slot + 1);
  for_each_used([](auto& values) { values.emplace_back(); });
  return slot;
}

void ActiveVertices::write_more(std::uint32_t slot, const TriangleMesh& from, std::uint32_t index) {
  for_each_vertex_array(from, buffer_, [&](const auto& values, auto& slots) {
    if (!slots.empty()) slots[slot] = values[index];
  });
}

namespace {

// Opposite normals meet at zero, where there is no direction: it stays until the end is nearer.
void approach_normal(Vec3& normal, const Vec3& goal, float part) {
  const Vec3 sum = normal + part * (goal - normal);
  const float square = glm::dot(sum, sum);
  if (square > 1e-12f && std::isfinite(square)) normal = sum / std::sqrt(square);
}

}  // namespace

void ActiveVertices::approach_more(std::uint32_t slot, const TriangleMesh& goal,
                                   std::uint32_t index, float part) {
  if (buffer_.has_normals()) approach_normal(buffer_.normals[slot], goal.normals[index], part);
  for (std::size_t i = 0; i < buffer_.poses.size(); ++i) {
    Pose& pose = buffer_.poses[i];
    pose.positions[slot] += part * goal.poses[i].positions[index] - part * pose.positions[slot];
    if (!pose.normals.empty())
      pose.normals[slot] += part * (goal.poses[i].normals[index] - pose.normals[slot]);
  }
  if (buffer_.has_skin())
    buffer_.skin[slot] = mix_joints(buffer_.skin[slot], goal.skin[index], part);
  if (buffer_.has_texcoords()) {
    Vec2& texcoord = buffer_.texcoords[slot];
    texcoord += part * goal.texcoords[index] - part * texcoord;
  }
  if (!buffer_.has_colors()) return;
  Color& color = buffer_.colors[slot];
  for (int i = 0; i < 4; ++i) {
    const auto way = static_cast<float>(goal.colors[index][i] - color[i]);
    color[i] = static_cast<std::uint8_t>(color[i] + std::lround(part * way));
  }
}

std::size_t ActiveVertices::bytes() const {
  std::size_t sum = 0;
  for_each_vertex_array(buffer_,
                        [&](const auto& values) { sum += values.capacity() * sizeof(values[0]); });
  return sum + (slot_of_.size() + free_.capacity()) * sizeof(std::uint32_t) + dirty_.bytes();
}

}  // namespace varifold
