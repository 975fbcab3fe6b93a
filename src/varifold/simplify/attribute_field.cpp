#include <varifold/simplify/attribute_field.h>

#include <algorithm>

namespace varifold {

AttributeField::AttributeField(const TriangleMesh& mesh, const AttributeWeights& weights) {
  const bool normals = mesh.has_normals() && weights.normal > 0;
  const bool texcoords = mesh.has_texcoords() && weights.texcoord > 0;
  const bool colors = mesh.has_colors() && weights.color > 0;
  channels_ = 3 * normals + 2 * texcoords + 4 * colors;
  if (channels_ == 0) return;

  values_.reserve(std::size_t{mesh.vertex_count()} * channels_);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (normals)
      for (int k = 0; k < 3; ++k) values_.push_back(weights.normal * mesh.normals[v][k]);
    if (texcoords)
      for (int k = 0; k < 2; ++k) values_.push_back(weights.texcoord * mesh.texcoords[v][k]);
    if (colors)
      for (int k = 0; k < 4; ++k) values_.push_back(weights.color / 255 * mesh.colors[v][k]);
  }
  terms_.resize(values_.size());
  quadrics_.resize(mesh.vertex_count());
  weights_.assign(mesh.vertex_count(), 0);
}

void AttributeField::add_face(const std::array<std::uint32_t, 3>& wedges, const Vec3& edge_1,
                              const Vec3& edge_2, float weight) {
  // The gradient g lies in the plane of the edges, with g.e1 = s1 - s0 and g.e2 = s2 - s0.
  const float d11 = glm::dot(edge_1, edge_1);
  const float d12 = glm::dot(edge_1, edge_2);
  const float d22 = glm::dot(edge_2, edge_2);
  const float determinant = d11 * d22 - d12 * d12;
  weights_[wedges[0]] += weight;
  if (determinant <= 1e-6f * d11 * d22) return;  // a needle has no reliable gradient
  const Vec3 dual_1 = (d22 * edge_1 - d12 * edge_2) / determinant;
  const Vec3 dual_2 = (d11 * edge_2 - d12 * edge_1) / determinant;
  const float* s0 = values(wedges[0]);
  const float* s1 = values(wedges[1]);
  const float* s2 = values(wedges[2]);
  Term* terms = &terms_[std::size_t{wedges[0]} * channels_];
  for (int k = 0; k < channels_; ++k) {
    const Vec3 g = (s1[k] - s0[k]) * dual_1 + (s2[k] - s0[k]) * dual_2;
    terms[k].gradient += weight * g;
    quadrics_[wedges[0]].add_plane(g, weight);
  }
}

float AttributeField::coupling(std::uint32_t wedge, std::uint32_t onto, const Vec3& d) const {
  const float* from_values = values(wedge);
  const float* onto_values = values(onto);
  const Term* terms = &terms_[std::size_t{wedge} * channels_];
  float sum = 0;
  for (int k = 0; k < channels_; ++k) {
    const float change = onto_values[k] - from_values[k];
    const float slope = glm::dot(terms[k].gradient, d) + terms[k].offset;
    sum += change * (weights_[wedge] * change - 2 * slope);
  }
  return sum;
}

float AttributeField::cost(std::uint32_t wedge, std::uint32_t onto, const Vec3& d) const {
  return std::max(0.0f, quadrics_[wedge].at(d) + coupling(wedge, onto, d));
}

void AttributeField::merge(std::uint32_t wedge, std::uint32_t onto, const Vec3& d) {
  Quadric moved = quadrics_[wedge].moved_by(d);
  moved.c = std::max(0.0f, moved.c + coupling(wedge, onto, d));
  const float* from_values = values(wedge);
  const float* onto_values = values(onto);
  const Term* terms = &terms_[std::size_t{wedge} * channels_];
  Term* onto_terms = &terms_[std::size_t{onto} * channels_];
  const float weight = weights_[wedge];
  for (int k = 0; k < channels_; ++k) {
    const float change = onto_values[k] - from_values[k];
    moved.b -= change * terms[k].gradient;
    onto_terms[k].gradient += terms[k].gradient;
    onto_terms[k].offset += terms[k].offset + glm::dot(terms[k].gradient, d) - weight * change;
  }
  quadrics_[onto] += moved;
  weights_[onto] += weight;
}

float AttributeField::distance_squared(std::uint32_t a, std::uint32_t b) const {
  float sum = 0;
  for (int k = 0; k < channels_; ++k) {
    const float difference = values(a)[k] - values(b)[k];
    sum += difference * difference;
  }
  return sum;
}

std::size_t AttributeField::bytes() const {
  return (values_.capacity() + weights_.capacity()) * sizeof(float) +
         terms_.capacity() * sizeof(Term) + quadrics_.capacity() * sizeof(Quadric);
}

}  // namespace varifold
