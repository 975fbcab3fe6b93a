#include <varifold/partition/patch_levels.h>

#include <varifold/base/disjoint_sets.h>
#include <varifold/partition/cluster_graph.h>
#include <varifold/partition/edge_links.h>
#include <varifold/partition/merge_rounds.h>
#include <varifold/partition/small_regions.h>
#include <algorithm>
#include <cmath>
#include <utility>

namespace varifold {

namespace {

std::vector<Box> patch_boxes(const SurfaceView& surface, const Partition& partition) {
  std::vector<Box> boxes(partition.patch_count);
  for (std::uint32_t h = 0; h < surface.corners.size(); ++h)
    boxes[partition.patch_of[h / 3]].add(surface.positions[surface.corners[h]]);
  return boxes;
}

// The distance between two boxes, 0 where they meet.
float gap_between(const Box& a, const Box& b) {
  const Vec3 gap = glm::max(glm::max(a.lower - b.upper, b.lower - a.upper), Vec3(0));
  return glm::length(gap);
}

// Rows of links with those in `extra` (pairs of clusters) added.
void add_links(ClusterGraph& graph,
               const std::vector<std::pair<std::uint32_t, ClusterLink>>& extra) {
  LargeVector<ClusterLink> links;
  links.reserve(graph.links.size() + extra.size());
  std::size_t next = 0;
  for (std::uint32_t c = 0; c < graph.size(); ++c) {
    const auto begin = static_cast<std::uint32_t>(links.size());
    for (const ClusterLink& link : graph.links_of(c)) links.push_back(link);
    for (; next < extra.size() && extra[next].first == c; ++next)
      links.push_back(extra[next].second);
    graph.link_rows[c] = {begin, static_cast<std::uint32_t>(links.size()) - begin};
  }
  graph.links = std::move(links);
}

// Links patches of different components that follow each other on a Morton curve, so that the graph
// is connected.
void link_components(const SurfaceView& surface, const Partition& partition, float unit,
                     ClusterGraph& graph) {
  DisjointSets components(graph.size());
  for (std::uint32_t c = 0; c < graph.size(); ++c)
    for (const ClusterLink& link : graph.links_of(c)) components.unite(c, link.other);
  if (components.set_count() < 2) return;

  const std::vector<Box> boxes = patch_boxes(surface, partition);
  Box all;
  for (const Box& box : boxes) all.add(box.center());
  std::vector<std::pair<std::uint64_t, std::uint32_t>> curve;
  for (std::uint32_t c = 0; c < graph.size(); ++c)
    curve.emplace_back(morton_code(boxes[c].center(), all), c);
  std::sort(curve.begin(), curve.end());

  std::vector<std::pair<std::uint32_t, ClusterLink>> extra;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const std::uint32_t a = curve[i - 1].second, b = curve[i].second;
    if (components.find(a) == components.find(b)) continue;
    const float gap = gap_between(boxes[a], boxes[b]) / unit;
    extra.push_back({a, {b, -gap, 0}});
    extra.push_back({b, {a, -gap, 0}});
  }
  std::stable_sort(extra.begin(), extra.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  add_links(graph, extra);
}

// Merges to the wanted number: discs if possible, then what keeps the cap, then anything.
void merge_to(MergeRounds& rounds, std::uint32_t clusters, std::uint32_t triangles) {
  MergeLimits limits;
  limits.clusters = clusters;
  float cap = kMaxPatchExcess * static_cast<float>(triangles) / static_cast<float>(clusters);
  limits.max_triangles = static_cast<std::uint32_t>(std::min(std::ceil(cap), 4e9f));
  rounds.run(limits);
  limits.discs = false;
  while (rounds.alive().size() > clusters) {
    rounds.run(limits);
    if (limits.max_triangles >= triangles) break;
    cap *= 1.25f;
    limits.max_triangles = static_cast<std::uint32_t>(std::min(std::ceil(cap), 4e9f));
  }
}

// Numbers the patches of every level by their parents.
void number_by_parents(PatchLevels& levels, Partition& partition) {
  std::vector<std::uint32_t> number;  // of the level above
  for (std::size_t l = levels.parent.size(); l-- > 0;) {
    std::vector<std::uint32_t>& parent = levels.parent[l];
    if (!number.empty())
      for (std::uint32_t& p : parent) p = number[p];
    std::vector<std::uint32_t> order(parent.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return parent[a] < parent[b]; });
    number.assign(parent.size(), 0);
    for (std::uint32_t i = 0; i < order.size(); ++i) number[order[i]] = i;
    std::stable_sort(parent.begin(), parent.end());
  }
  for (std::uint32_t& patch : partition.patch_of) patch = number[patch];
  const std::vector<std::int32_t> euler = partition.euler;
  for (std::uint32_t p = 0; p < partition.patch_count; ++p) partition.euler[number[p]] = euler[p];
}

}  // namespace

PatchLevels make_levels(const SurfaceView& surface, Partition& partition, int threads) {
  return make_levels(surface, EdgeLinks(surface), partition, threads);
}

PatchLevels make_levels(const SurfaceView& surface, const EdgeLinks& links, Partition& partition,
                        int threads) {
  PatchLevels levels;
  if (partition.patch_count == 0) return levels;
  const ClusterMap map{partition.patch_of, partition.patch_count};
  const float unit = length_unit(surface);
  ClusterGraph graph = build_cluster_graph(
      surface, links, map, {.across_materials = true, .unit = unit, .threads = threads});
  for (std::uint32_t c = 0; c < map.count; ++c) graph.shapes[c].euler = partition.euler[c];
  link_components(surface, partition, unit, graph);

  MergeRounds rounds(std::move(graph), threads);
  std::vector<std::uint32_t> number(map.count);
  while (rounds.alive().size() > 1) {
    const std::vector<std::uint32_t> before = rounds.alive();
    merge_to(rounds, static_cast<std::uint32_t>(before.size() + 1) / 2, surface.triangle_count());
    for (std::uint32_t i = 0; i < rounds.alive().size(); ++i) number[rounds.alive()[i]] = i;
    std::vector<std::uint32_t>& parent = levels.parent.emplace_back();
    parent.reserve(before.size());
    if (rounds.alive().size() == before.size()) {  // only where lengths are not finite
      parent.assign(before.size(), 0);
      break;
    }
    for (const std::uint32_t c : before) parent.push_back(number[rounds.cluster_of(c)]);
  }
  levels.parent.emplace_back(1, kNone);
  number_by_parents(levels, partition);
  return levels;
}

PatchNeighbors patch_neighbors(std::span<const std::uint32_t> points,
                               std::span<const std::uint32_t> first, std::uint32_t point_count) {
  const auto patch_count = static_cast<std::uint32_t>(first.size() - 1);
  // Find the points of several patches.
  std::vector<std::uint32_t> owner(point_count, kNone);
  std::vector<std::uint64_t> meetings;  // point, patch
  for (std::uint32_t patch = 0; patch < patch_count; ++patch)
    for (const std::uint32_t point :
         points.subspan(first[patch], first[patch + 1] - first[patch])) {
      if (owner[point] == kNone) owner[point] = patch;
      if (owner[point] != patch) meetings.push_back(std::uint64_t{point} << 32 | patch);
    }
  std::sort(meetings.begin(), meetings.end());
  meetings.erase(std::unique(meetings.begin(), meetings.end()), meetings.end());

  // Every two patches at a point are neighbours.
  std::vector<std::uint64_t> pairs;
  std::vector<std::uint32_t> here;
  for (std::size_t i = 0; i < meetings.size();) {
    const auto point = static_cast<std::uint32_t>(meetings[i] >> 32);
    here.assign(1, owner[point]);
    for (; i < meetings.size() && meetings[i] >> 32 == point; ++i)
      here.push_back(static_cast<std::uint32_t>(meetings[i]));
    for (const std::uint32_t a : here)
      for (const std::uint32_t b : here)
        if (a != b) pairs.push_back(std::uint64_t{a} << 32 | b);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());

  PatchNeighbors result;
  result.first.assign(std::size_t{patch_count} + 1, 0);
  for (const std::uint64_t pair : pairs) ++result.first[(pair >> 32) + 1];
  for (std::uint32_t p = 0; p < patch_count; ++p) result.first[p + 1] += result.first[p];
  result.neighbors.reserve(pairs.size());
  for (const std::uint64_t pair : pairs)
    result.neighbors.push_back(static_cast<std::uint32_t>(pair));
  return result;
}

}  // namespace varifold
