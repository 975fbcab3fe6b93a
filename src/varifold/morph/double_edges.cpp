#include <varifold/mesh/vertex_arrays.h>
#include <varifold/morph/double_edges.h>
#include <varifold/morph/sphere_triangulation.h>
#include <algorithm>
#include <type_traits>
#include <utility>

namespace varifold {

std::uint32_t DoubleEdges::split(bool has_border) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<std::pair<Edge, std::uint32_t>> edges;
  for (std::uint32_t h = 0; h < opposite_.size(); ++h) {
    const std::uint32_t from = point_of_[h], to = point_of_[next_half_edge(h)];
    const bool is_open = opposite_[h] == kNone && from != kNone && to != kNone;
    if (opposite_[h] != kNone ? h < opposite_[h] : is_open && has_border)
      edges.push_back({{std::min(from, to), std::max(from, to)}, h});
  }
  std::sort(edges.begin(), edges.end());
  std::uint32_t count = 0;
  std::vector<std::uint32_t> middle_of(mesh_.indices.size(), kNone);
  for (std::size_t i = 1; i < edges.size(); ++i) {
    if (edges[i].first != edges[i - 1].first) continue;
    const std::uint32_t h = edges[i].second, other = opposite_[h];
    const Vec3 nudge =
        0.5f * kRepairNudge * (opposite_corner(h) + opposite_corner(other == kNone ? h : other));
    for (const std::uint32_t side : {h, other})
      if (side != kNone) middle_of[side] = add_middle(side, nudge);
    ++count;
  }
  if (count > 0) cut_triangles(middle_of);
  return count;
}

const Vec3& DoubleEdges::opposite_corner(std::uint32_t half_edge) const {
  return mesh_.positions[mesh_.indices[next_half_edge(next_half_edge(half_edge))]];
}

// A vertex in the middle of an edge, with the attributes of one side.
std::uint32_t DoubleEdges::add_middle(std::uint32_t half_edge, const Vec3& nudge) {
  const std::uint32_t from = mesh_.indices[half_edge],
                      to = mesh_.indices[next_half_edge(half_edge)];
  for_each_vertex_array(mesh_, [&]<class Value>(std::vector<Value>& values) {
    if constexpr (!std::is_same_v<Value, JointWeights>) {
      if (values.empty()) return;
      glm::vec<Value::length(), double> sum(values[from]);
      sum += glm::vec<Value::length(), double>(values[to]);
      values.push_back(Value(0.5 * sum));
    }
  });
  // Summed in the order of the places, so that both sides agree bit by bit.
  mesh_.positions.back() = (1 - kRepairNudge) * mesh_.positions.back() + nudge;
  if (mesh_.has_normals()) mesh_.normals.back() = normalize_or_zero(mesh_.normals.back());
  return mesh_.vertex_count() - 1;
}

// Fans about the middles of edges that have one.
void DoubleEdges::cut_triangles(const std::vector<std::uint32_t>& middle_of) {
  std::vector<std::uint32_t> indices, materials, polygon;
  for (std::uint32_t t = 0; t < mesh_.triangle_count(); ++t) {
    polygon.clear();
    std::size_t apex = 0;
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      polygon.push_back(mesh_.indices[h]);
      if (middle_of[h] == kNone) continue;
      apex = polygon.size();
      polygon.push_back(middle_of[h]);
    }
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      indices.insert(indices.end(), {polygon[apex], polygon[(apex + i) % polygon.size()],
                                     polygon[(apex + i + 1) % polygon.size()]});
      materials.push_back(material_of_[t]);
    }
  }
  mesh_.indices = std::move(indices);
  material_of_ = std::move(materials);
}

}  // namespace varifold
