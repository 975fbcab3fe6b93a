#include <varifold/strip/adjacency.h>

#include <algorithm>

namespace varifold {

namespace {

// An edge at the lower of its two vertices.
struct Spoke {
  std::uint32_t upper;      // the other vertex
  std::uint32_t half_edge;  // sorted by (upper, half_edge), so that the result is one
  friend bool operator<(const Spoke& a, const Spoke& b) {
    return a.upper != b.upper ? a.upper < b.upper : a.half_edge < b.half_edge;
  }
};

// Spokes in rows, one per lower vertex.
struct SpokeRows {
  std::vector<std::uint32_t> begin;
  std::vector<Spoke> spokes;
};

template <class Visit>
void for_each_edge(const TriangleMesh& mesh, const Visit& visit) {
  const std::uint32_t* indices = mesh.indices.data();
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (is_degenerate(mesh.indices, t)) continue;
    for (std::uint32_t e = 0; e < 3; ++e) {
      const std::uint32_t a = indices[3 * t + e], b = indices[3 * t + (e + 1) % 3];
      visit(std::min(a, b), std::max(a, b), 3 * t + e);
    }
  }
}

SpokeRows spoke_rows(const TriangleMesh& mesh) {
  SpokeRows rows;
  rows.begin.assign(std::size_t{mesh.vertex_count()} + 1, 0);
  for_each_edge(
      mesh, [&](std::uint32_t lower, std::uint32_t, std::uint32_t) { ++rows.begin[lower + 1]; });
  for (std::size_t v = 1; v < rows.begin.size(); ++v) rows.begin[v] += rows.begin[v - 1];
  rows.spokes.resize(rows.begin.back());
  std::vector<std::uint32_t> next(rows.begin.begin(), rows.begin.end() - 1);
  for_each_edge(mesh, [&](std::uint32_t lower, std::uint32_t upper, std::uint32_t half_edge) {
    rows.spokes[next[lower]++] = {upper, half_edge};
  });
  for (std::size_t v = 0; v + 1 < rows.begin.size(); ++v)
    std::sort(rows.spokes.begin() + rows.begin[v], rows.spokes.begin() + rows.begin[v + 1]);
  return rows;
}

}  // namespace

std::vector<std::uint32_t> edge_adjacency(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> across(mesh.indices.size(), kNone);
  const SpokeRows rows = spoke_rows(mesh);
  const std::vector<std::uint32_t> range = triangle_ranges(mesh);
  for (std::size_t v = 0; v + 1 < rows.begin.size(); ++v) {
    for (std::uint32_t i = rows.begin[v], end = i; i < rows.begin[v + 1]; i = end) {
      while (end < rows.begin[v + 1] && rows.spokes[end].upper == rows.spokes[i].upper) ++end;
      if (end - i != 2) continue;
      const std::uint32_t a = rows.spokes[i].half_edge, b = rows.spokes[i + 1].half_edge;
      const bool opposite = mesh.indices[a] != mesh.indices[b];  // they begin at different ends
      if (!opposite || range[a / 3] != range[b / 3]) continue;
      across[a] = b;
      across[b] = a;
    }
  }
  return across;
}

std::vector<std::uint32_t> triangle_ranges(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> range(mesh.triangle_count(), 0);
  for (std::uint32_t r = 0; r < mesh.ranges.size(); ++r)
    std::fill_n(range.begin() + mesh.ranges[r].first_triangle, mesh.ranges[r].triangle_count, r);
  return range;
}

}  // namespace varifold
