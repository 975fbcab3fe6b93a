#include <varifold/measure/surface_counts.h>

#include <varifold/base/disjoint_sets.h>
#include <varifold/mesh/weld.h>
#include <algorithm>
#include <array>
#include <tuple>

namespace varifold::check {

namespace {

// An edge between two classes, the lower first, and whether the triangle runs from that.
struct HalfEdge {
  std::uint32_t low, high;
  bool is_forward;
  friend bool operator<(const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.is_forward) < std::tie(b.low, b.high, b.is_forward);
  }
};

using Corners = std::array<std::uint32_t, 3>;

std::vector<Corners> triangles_of(const TriangleMesh& mesh, const WeldMap& weld,
                                  SurfaceCounts& counts) {
  std::vector<Corners> triangles;
  triangles.reserve(mesh.triangle_count());
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Corners c{weld.class_of[mesh.indices[i]], weld.class_of[mesh.indices[i + 1]],
                    weld.class_of[mesh.indices[i + 2]]};
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0])
      ++counts.degenerate_triangles;
    else
      triangles.push_back(c);
  }
  return triangles;
}

// Calls visit(first, end) for each run of half-edges of one edge.
template <class Visit>
void for_each_edge(const std::vector<HalfEdge>& edges, const Visit& visit) {
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high)
      ++end;
    visit(i, end);
  }
}

}  // namespace

SurfaceCounts count_surface(const TriangleMesh& mesh) {
  SurfaceCounts counts;
  const WeldMap weld = weld_points(mesh);
  std::vector<Corners> triangles = triangles_of(mesh, weld, counts);
  DisjointSets sets(weld.class_count);
  std::vector<HalfEdge> edges;
  edges.reserve(3 * triangles.size());
  std::vector<std::int64_t> euler(weld.class_count, 0);  // at the representatives
  std::vector<std::uint8_t> is_used(weld.class_count, 0);
  for (const Corners& c : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = c[k], b = c[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b});
      sets.unite(a, b);
      is_used[a] = 1;
    }
  std::sort(edges.begin(), edges.end());
  for_each_edge(edges, [&](std::size_t first, std::size_t end) {
    const std::size_t count = end - first;
    if (count == 1) ++counts.boundary_edges;
    if (count > 2) ++counts.nonmanifold_edges;
    if (count == 2 && edges[first].is_forward == edges[first + 1].is_forward)
      ++counts.misoriented_edges;
    --euler[sets.find(edges[first].low)];
  });
  for (std::uint32_t p = 0; p < weld.class_count; ++p)
    if (is_used[p]) ++euler[sets.find(p)];
  for (Corners& c : triangles) {
    ++euler[sets.find(c[0])];
    std::sort(c.begin(), c.end());
  }
  std::sort(triangles.begin(), triangles.end());
  for (std::size_t t = 1; t < triangles.size(); ++t)
    if (triangles[t] == triangles[t - 1]) ++counts.duplicate_triangles;
  for (std::uint32_t p = 0; p < weld.class_count; ++p)
    if (is_used[p] && sets.find(p) == p) counts.euler_of_component.push_back(euler[p]);
  std::sort(counts.euler_of_component.begin(), counts.euler_of_component.end());
  return counts;
}

bool are_among(const std::vector<std::int64_t>& parts, const std::vector<std::int64_t>& whole) {
  return std::includes(whole.begin(), whole.end(), parts.begin(), parts.end());
}

}  // namespace varifold::check
