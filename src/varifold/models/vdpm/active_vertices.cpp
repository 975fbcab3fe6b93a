#include <varifold/models/vdpm/active_vertices.h>

#include <varifold/models/common/extract_level.h>
#include <cmath>

namespace varifold {

ActiveVertices::ActiveVertices(const TriangleMesh& attributes)
    : has_normals_(attributes.has_normals()),
      has_texcoords_(attributes.has_texcoords()),
      has_colors_(attributes.has_colors()),
      has_more_(has_normals_ || has_texcoords_ || has_colors_),
      slot_of_(attributes.vertex_count(), kNone) {}

void ActiveVertices::reserve(std::uint32_t vertices) {
  reserve_for(buffer_.positions, vertices);
  const std::size_t room = buffer_.positions.capacity();
  if (has_normals_) buffer_.normals.reserve(room);
  if (has_texcoords_) buffer_.texcoords.reserve(room);
  if (has_colors_) buffer_.colors.reserve(room);
  free_.reserve(room);
  dirty_.grow(room);
}

std::uint32_t ActiveVertices::new_slot() {
  const std::uint32_t slot = slots();
  reserve(slot + 1);
  buffer_.positions.emplace_back();
  if (has_normals_) buffer_.normals.emplace_back();
  if (has_texcoords_) buffer_.texcoords.emplace_back();
  if (has_colors_) buffer_.colors.emplace_back();
  return slot;
}

void ActiveVertices::write_more(std::uint32_t slot, const TriangleMesh& from, std::uint32_t index) {
  if (has_normals_) buffer_.normals[slot] = from.normals[index];
  if (has_texcoords_) buffer_.texcoords[slot] = from.texcoords[index];
  if (has_colors_) buffer_.colors[slot] = from.colors[index];
}

void ActiveVertices::approach_more(std::uint32_t slot, const TriangleMesh& goal,
                                   std::uint32_t index, float part) {
  if (has_normals_) {
    Vec3& normal = buffer_.normals[slot];
    const Vec3 sum = normal + part * (goal.normals[index] - normal);
    const float square = glm::dot(sum, sum);
    // Opposite normals meet at zero, where there is no direction: it stays until the end is nearer.
    if (square > 1e-12f && std::isfinite(square)) normal = sum / std::sqrt(square);
  }
  if (has_texcoords_) {
    Vec2& texcoord = buffer_.texcoords[slot];
    texcoord += part * goal.texcoords[index] - part * texcoord;
  }
  if (!has_colors_) return;
  Color& color = buffer_.colors[slot];
  for (int i = 0; i < 4; ++i) {
    const auto way = static_cast<float>(goal.colors[index][i] - color[i]);
    color[i] = static_cast<std::uint8_t>(color[i] + std::lround(part * way));
  }
}

std::size_t ActiveVertices::bytes() const {
  const std::size_t room = buffer_.positions.capacity();
  return room * ((has_normals_ ? 2 : 1) * sizeof(Vec3) + (has_texcoords_ ? sizeof(Vec2) : 0) +
                 (has_colors_ ? sizeof(Color) : 0)) +
         (slot_of_.size() + free_.capacity()) * sizeof(std::uint32_t) + dirty_.bytes();
}

}  // namespace varifold
