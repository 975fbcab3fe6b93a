#include <varifold/simplify/attribute_field.h>

#include <algorithm>
#include <cmath>

namespace varifold {

AttributeField::AttributeField(const TriangleMesh& mesh, std::span<const std::uint32_t> vertex_of,
                               const AttributeWeights& weights) {
  const bool normals = mesh.has_normals() && weights.normal > 0;
  const bool texcoords = mesh.has_texcoords() && weights.texcoord > 0;
  const bool colors = mesh.has_colors() && weights.color > 0;
  channel_count_ = 3 * normals + 2 * texcoords + 4 * colors;
  if (channel_count_ == 0) return;

  stride_ = kHeadFloats + kChannelFloats * static_cast<std::size_t>(channel_count_);
  data_.assign(vertex_of.size() * stride_, 0.0f);
  for (std::uint32_t w = 0; w < vertex_of.size(); ++w) {
    const std::uint32_t v = vertex_of[w];
    Channel* channel = channels(w);
    if (normals)
      for (int k = 0; k < 3; ++k) (channel++)->value = weights.normal * mesh.normals[v][k];
    if (texcoords)
      for (int k = 0; k < 2; ++k) (channel++)->value = weights.texcoord * mesh.texcoords[v][k];
    if (colors)
      for (int k = 0; k < 4; ++k) (channel++)->value = weights.color / 255 * mesh.colors[v][k];
  }
}

void AttributeField::add_face(const std::array<std::uint32_t, 3>& wedges, const Vec3& edge_1,
                              const Vec3& edge_2) {
  // The gradient g lies in the plane of the edges, with g.e1 = s1 - s0 and g.e2 = s2 - s0.
  const float d11 = glm::dot(edge_1, edge_1);
  const float d12 = glm::dot(edge_1, edge_2);
  const float d22 = glm::dot(edge_2, edge_2);
  const float determinant = d11 * d22 - d12 * d12;  // (twice the area)^2
  const float weight = std::sqrt(std::max(0.0f, determinant)) / 6;
  Head& own = head(wedges[0]);
  own.weight += weight;
  if (determinant <= 1e-6f * d11 * d22) return;  // a needle has no reliable gradient
  const Vec3 dual_1 = (d22 * edge_1 - d12 * edge_2) / determinant;
  const Vec3 dual_2 = (d11 * edge_2 - d12 * edge_1) / determinant;
  Channel* s0 = channels(wedges[0]);
  const Channel* s1 = channels(wedges[1]);
  const Channel* s2 = channels(wedges[2]);
  for (int k = 0; k < channel_count_; ++k) {
    const Vec3 g = (s1[k].value - s0[k].value) * dual_1 + (s2[k].value - s0[k].value) * dual_2;
    s0[k].gradient += weight * g;
    own.quadric.add_plane(g, weight);
  }
}

AttributeField::Values AttributeField::values(std::uint32_t wedge) const {
  Values result{};
  const Channel* channel = channels(wedge);
  for (int k = 0; k < channel_count_; ++k) result[static_cast<std::size_t>(k)] = channel[k].value;
  return result;
}

AttributeField::Values AttributeField::blended(const Blend& blend) const {
  Values result{};
  const Channel* from = channels(blend.wedge);
  const Channel* to = channels(blend.onto);
  for (int k = 0; k < channel_count_; ++k)
    result[static_cast<std::size_t>(k)] = (1 - blend.t) * from[k].value + blend.t * to[k].value;
  return result;
}

float AttributeField::coupling(std::uint32_t wedge, const Values& values, const Vec3& d) const {
  const Channel* from = channels(wedge);
  const float weight = head(wedge).weight;
  float sum = 0;
  for (int k = 0; k < channel_count_; ++k) {
    const float change = values[static_cast<std::size_t>(k)] - from[k].value;
    const float slope = glm::dot(from[k].gradient, d) + from[k].offset;
    sum += change * (weight * change - 2 * slope);
  }
  return sum;
}

float AttributeField::cost(std::uint32_t wedge, const Values& values, const Vec3& d) const {
  return std::max(0.0f, head(wedge).quadric.at(d) + coupling(wedge, values, d));
}

float AttributeField::cost(std::uint32_t wedge, std::uint32_t onto, const Vec3& d) const {
  return cost(wedge, values(onto), d);
}

float AttributeField::cost(const Blend& blend) const {
  const Values values = blended(blend);
  return cost(blend.wedge, values, blend.d) + cost(blend.onto, values, blend.onto_d);
}

void AttributeField::move(std::uint32_t wedge, const Values& values, const Vec3& d) {
  Head& own = head(wedge);
  Quadric moved = own.quadric.moved_by(d);
  moved.c = std::max(0.0f, moved.c + coupling(wedge, values, d));
  Channel* channel = channels(wedge);
  for (int k = 0; k < channel_count_; ++k) {
    const float change = values[static_cast<std::size_t>(k)] - channel[k].value;
    moved.b -= change * channel[k].gradient;
    channel[k].offset += glm::dot(channel[k].gradient, d) - own.weight * change;
    channel[k].value = values[static_cast<std::size_t>(k)];
  }
  own.quadric = moved;
}

void AttributeField::add(std::uint32_t wedge, std::uint32_t onto) {
  const Channel* from = channels(wedge);
  Channel* to = channels(onto);
  for (int k = 0; k < channel_count_; ++k) {
    to[k].gradient += from[k].gradient;
    to[k].offset += from[k].offset;
  }
  head(onto).quadric += head(wedge).quadric;
  head(onto).weight += head(wedge).weight;
}

void AttributeField::merge(std::uint32_t wedge, std::uint32_t onto, const Vec3& d) {
  move(wedge, values(onto), d);
  add(wedge, onto);
}

void AttributeField::merge(const Blend& blend) {
  const Values values = blended(blend);
  move(blend.wedge, values, blend.d);
  move(blend.onto, values, blend.onto_d);
  add(blend.wedge, blend.onto);
}

float AttributeField::distance_squared(std::uint32_t a, std::uint32_t b) const {
  const Channel* at_a = channels(a);
  const Channel* at_b = channels(b);
  float sum = 0;
  for (int k = 0; k < channel_count_; ++k) {
    const float difference = at_a[k].value - at_b[k].value;
    sum += difference * difference;
  }
  return sum;
}

std::size_t AttributeField::bytes() const { return data_.capacity() * sizeof(float); }

}  // namespace varifold
