#include <varifold/partition/cluster_graph.h>

#include <varifold/base/parallel.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace varifold {

namespace {

constexpr std::size_t kGrain = 8192;

struct Builder {
  const SurfaceView& surface;
  const EdgeLinks& edges;
  const ClusterMap& map;
  bool across_materials;
  float scale;  // of half lengths, which cannot run over

  // The cluster across a half-edge, or kNone.
  [[nodiscard]] std::uint32_t beyond(std::uint32_t half_edge) const {
    const std::uint32_t g =
        across_materials ? edges.across(half_edge) : edges.across_in_material(half_edge);
    const std::uint32_t at = g / 3 - map.first;
    return g == kNone || at >= map.cluster_of.size() ? kNone : map.cluster_of[at];
  }
  [[nodiscard]] float length(std::uint32_t half_edge) const {
    return glm::length(
        side(surface.corners[half_edge], surface.corners[next_in_triangle(half_edge)]));
  }
  [[nodiscard]] float area(std::uint32_t triangle) const {
    const std::uint32_t* c = surface.corners.data() + 3 * std::size_t{triangle};
    return 0.5f * glm::length(glm::cross(side(c[0], c[1]), side(c[0], c[2])));
  }
  [[nodiscard]] Vec3 side(std::uint32_t from, std::uint32_t to) const {
    return (0.5f * surface.positions[to] - 0.5f * surface.positions[from]) * scale;
  }
  void list_borders(ClusterGraph& graph, std::span<const float> areas) const;
  void describe(ClusterGraph& graph, std::uint32_t cluster, std::vector<std::uint32_t>& ends) const;
};

// Adds what a half-edge has in common with a neighbour to the row.
void add_common_edge(ClusterLink* row, std::uint32_t& count, std::uint32_t other, float length) {
  for (std::uint32_t i = count; i > 0; --i) {
    if (row[i - 1].other != other) continue;
    row[i - 1].length += length;
    ++row[i - 1].edges;
    return;
  }
  row[count++] = {other, length, 1};
}

// Sums of this are equal where the points are, and hardly ever else.
std::uint64_t mixed(std::uint32_t point) {
  const std::uint64_t x = point * 0x9e3779b97f4a7c15u;
  return x ^ (x >> 32);
}

// The row of points holds the half-edges on the border before.
void Builder::describe(ClusterGraph& graph, std::uint32_t cluster,
                       std::vector<std::uint32_t>& ends) const {
  ClusterShape& shape = graph.shapes[cluster];
  Row& link_row = graph.link_rows[cluster];
  Row& point_row = graph.point_rows[cluster];
  std::uint32_t* points = graph.points.data() + point_row.begin;
  ends.clear();
  std::uint64_t starts = 0, stops = 0;
  for (std::uint32_t i = 0; i < point_row.count; ++i) {
    const std::uint32_t h = points[i];
    const float edge = length(h);
    shape.outline += edge;
    ends.push_back(surface.corners[h]);
    starts += mixed(surface.corners[h]);
    stops += mixed(surface.corners[next_in_triangle(h)]);
    const std::uint32_t other = beyond(h);
    if (other == kNone) continue;
    add_common_edge(graph.links.data() + link_row.begin, link_row.count, other, edge);
  }
  if (starts != stops)  // not a sum of loops that all run the same way: look at both ends
    for (std::uint32_t i = 0; i < point_row.count; ++i)
      ends.push_back(surface.corners[next_in_triangle(points[i])]);
  std::sort(ends.begin(), ends.end());
  point_row.count =
      static_cast<std::uint32_t>(std::unique_copy(ends.begin(), ends.end(), points) - points);
}

// Lists the half-edges on the border of every cluster in its row of points. No row of links or
// points will be longer.
void Builder::list_borders(ClusterGraph& graph, std::span<const float> areas) const {
  const auto n = static_cast<std::uint32_t>(map.cluster_of.size());
  std::vector<std::uint32_t> borders;
  borders.reserve(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t cluster = map.cluster_of[i], t = map.first + i;
    if (cluster == kNone) continue;
    ++graph.shapes[cluster].triangles;
    if (areas.empty()) graph.shapes[cluster].area += area(t);
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      if (beyond(h) == cluster) continue;
      borders.push_back(h);
      ++graph.point_rows[cluster].begin;
    }
  }
  std::uint32_t total = 0;
  for (std::uint32_t c = 0; c < map.count; ++c) {
    if (!areas.empty()) graph.shapes[c].area = areas[c];
    const std::uint32_t places = graph.point_rows[c].begin;
    graph.point_rows[c].begin = graph.link_rows[c].begin = total;
    total += places;
  }
  graph.links.resize(total);
  graph.points.resize(total);
  for (const std::uint32_t h : borders) {
    Row& row = graph.point_rows[map.cluster_of[h / 3 - map.first]];
    graph.points[row.begin + row.count++] = h;
  }
}

}  // namespace

float length_unit(const SurfaceView& surface) {
  Box box;
  for (const Vec3& p : surface.positions) box.add(0.5f * p);
  if (box.empty()) return 1;
  const Vec3 half = box.upper - box.lower;
  const float unit = 2 * std::max({half.x, half.y, half.z});
  return std::isfinite(unit) && std::isfinite(2 / unit) ? unit : 1;
}

ClusterGraph build_cluster_graph(const SurfaceView& surface, const EdgeLinks& links,
                                 const ClusterMap& map, const GraphOptions& options) {
  const Builder builder{surface, links, map, options.across_materials, 2 / options.unit};
  ClusterGraph graph;
  graph.shapes.resize(map.count);
  graph.link_rows.resize(map.count);
  graph.point_rows.resize(map.count);
  builder.list_borders(graph, options.areas);
  parallel_for(options.threads, map.count, kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> ends;
    for (auto c = static_cast<std::uint32_t>(begin); c < end; ++c) builder.describe(graph, c, ends);
  });
  if (!options.count_clusters_at) return graph;
  graph.clusters_at.assign(surface.positions.size(), 0);
  for (std::uint32_t c = 0; c < map.count; ++c)
    for (const std::uint32_t point : graph.points_of(c)) ++graph.clusters_at[point];
  return graph;
}

std::vector<std::int32_t> euler_characteristics(const SurfaceView& surface, const EdgeLinks& links,
                                                const ClusterMap& map) {
  std::vector<std::int32_t> euler(map.count, 0);
  LargeVector<std::uint32_t> owner(surface.positions.size(), kNone);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> shared;  // cluster, point
  const auto n = static_cast<std::uint32_t>(map.cluster_of.size());
  for (std::uint32_t t = 0; t < n; ++t) {
    const std::uint32_t cluster = map.cluster_of[t];
    if (cluster == kNone) continue;
    ++euler[cluster];
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      // An edge counts at the lower of its half-edges that are in the cluster.
      const std::uint32_t g = links.across(h);
      euler[cluster] -= g == kNone || g > h || map.cluster_of[g / 3] != cluster;
      // A point counts where it is met first; in other clusters it is noted.
      std::uint32_t& first = owner[surface.corners[h]];
      if (first == kNone) {
        first = cluster;
        ++euler[cluster];
      } else if (first != cluster) {
        shared.emplace_back(cluster, surface.corners[h]);
      }
    }
  }
  std::sort(shared.begin(), shared.end());
  shared.erase(std::unique(shared.begin(), shared.end()), shared.end());
  for (const auto& [cluster, point] : shared) ++euler[cluster];

  // Half-edges of an edge with many triangles were counted one by one.
  std::vector<std::array<std::uint32_t, 3>> many;  // cluster, lower point, upper point
  for (const std::uint32_t h : links.nonmanifold()) {
    if (map.cluster_of[h / 3] == kNone) continue;
    const std::uint32_t a = surface.corners[h], b = surface.corners[next_in_triangle(h)];
    many.push_back({map.cluster_of[h / 3], std::min(a, b), std::max(a, b)});
  }
  std::sort(many.begin(), many.end());
  for (std::size_t i = 1; i < many.size(); ++i)
    if (many[i] == many[i - 1]) ++euler[many[i][0]];
  return euler;
}

}  // namespace varifold
