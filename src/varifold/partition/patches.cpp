#include <varifold/partition/patches.h>

#include <varifold/partition/border_smoothing.h>
#include <varifold/partition/cluster_graph.h>
#include <varifold/partition/edge_links.h>
#include <varifold/partition/merge_rounds.h>
#include <varifold/partition/seed_clusters.h>
#include <varifold/partition/small_regions.h>
#include <varifold/partition/triangle_groups.h>
#include <algorithm>

namespace varifold {

namespace {

// Patches of fewer triangles are merged from single ones.
constexpr std::uint32_t kMinTrianglesForSeeds = 64;
constexpr std::uint32_t kMinTrianglesForGrowth = 128;
constexpr std::uint32_t kMaxSeedTriangles = 100;

std::uint32_t max_triangles(std::uint32_t triangles_per_patch) {
  return static_cast<std::uint32_t>(
      std::min(kMaxPatchExcess * static_cast<float>(triangles_per_patch), 1e9f));
}

// Glued triangles and small clusters of the rest, but nothing of small regions.
SeedClusters first_clusters(const SurfaceView& surface, const EdgeLinks& links,
                            const TriangleGroups& glued, const TriangleGroups& small,
                            const PartitionOptions& options, std::span<std::uint32_t> cluster_of) {
  constexpr std::uint32_t kSmall = kNone - 1;
  SeedClusters result;
  std::uint32_t count = 0;
  std::vector<std::uint32_t> cluster_of_group(glued.count, kNone);
  for (std::uint32_t t = 0; t < cluster_of.size(); ++t) {
    cluster_of[t] = small.of(t) != kNone ? kSmall : kNone;
    if (glued.of(t) == kNone || cluster_of[t] == kSmall) continue;
    std::uint32_t& cluster = cluster_of_group[glued.of(t)];
    if (cluster == kNone) cluster = count++;
    cluster_of[t] = cluster;
  }
  if (options.triangles_per_patch >= kMinTrianglesForSeeds) {
    const SeedOptions seeds{
        .triangles = std::clamp(options.triangles_per_patch / 4, 16u, kMaxSeedTriangles),
        .grow_to = options.triangles_per_patch >= kMinTrianglesForGrowth ? 18u : 0u,
        .unit = length_unit(surface),
        .threads = options.threads};
    result = seed_clusters(surface, links, seeds, cluster_of, count);
  } else {
    for (std::uint32_t& cluster : cluster_of)
      if (cluster == kNone) cluster = count++;
    result.count = count;
  }
  if (glued.count > 0) result.areas.clear();  // those of glued triangles are not known
  if (small.count > 0) std::replace(cluster_of.begin(), cluster_of.end(), kSmall, kNone);
  return result;
}

void merge_clusters(const SurfaceView& surface, const EdgeLinks& links,
                    const SeedClusters& clusters, const PartitionOptions& options,
                    Partition& partition) {
  const ClusterMap map{partition.patch_of, clusters.count};
  ClusterGraph graph = build_cluster_graph(
      surface, links, map,
      {.unit = length_unit(surface), .areas = clusters.areas, .threads = options.threads});
  if (!links.nonmanifold().empty()) {
    const std::vector<std::int32_t> euler = euler_characteristics(surface, links, map);
    for (std::uint32_t c = 0; c < map.count; ++c) graph.shapes[c].euler = euler[c];
  }
  std::uint32_t triangles = 0;
  for (const ClusterShape& shape : graph.shapes) triangles += shape.triangles;

  // Discs first; where that leaves too many patches, any.
  MergeRounds rounds(std::move(graph), options.threads);
  MergeLimits limits;
  limits.clusters = (triangles - 1) / options.triangles_per_patch + 1;
  limits.max_triangles = max_triangles(options.triangles_per_patch);
  rounds.run(limits);
  limits.discs = false;
  rounds.run(limits);
  partition.patch_count = static_cast<std::uint32_t>(rounds.alive().size());
  std::vector<std::uint32_t> patch_of(map.count);
  for (std::uint32_t p = 0; p < partition.patch_count; ++p) patch_of[rounds.alive()[p]] = p;
  for (const std::uint32_t c : rounds.alive()) partition.euler.push_back(rounds.shape(c).euler);
  for (std::uint32_t c = 0; c < map.count; ++c) patch_of[c] = patch_of[rounds.cluster_of(c)];
  for (std::uint32_t& entry : partition.patch_of)
    if (entry != kNone) entry = patch_of[entry];
}

void measure_rough(const SurfaceView& surface, const EdgeLinks& links, Partition& partition) {
  for (std::uint32_t h = 0; h < surface.corners.size(); ++h) {
    const std::uint32_t g = links.across(h);
    if (g == kNone || g > h || partition.patch_of[g / 3] == partition.patch_of[h / 3]) continue;
    ++partition.rough_border_edges;
    partition.rough_border_length +=
        glm::distance(DVec3(surface.positions[surface.corners[h]]),
                      DVec3(surface.positions[surface.corners[next_in_triangle(h)]]));
  }
}

}  // namespace

Partition make_patches(const SurfaceView& surface, const PartitionOptions& options) {
  return make_patches(surface, EdgeLinks(surface), options);
}

Partition make_patches(const SurfaceView& surface, const EdgeLinks& links,
                       const PartitionOptions& options) {
  Partition partition;
  partition.patch_of.resize(surface.triangle_count());
  if (surface.triangle_count() == 0) return partition;
  const auto is_cancelled = [&](float done) {
    if (report(options.progress, "patches", done)) return false;
    partition = {};
    partition.cancelled = true;
    return true;
  };
  if (is_cancelled(0)) return partition;

  // Set aside what merging cannot handle.
  const TriangleGroups glued =
      glue_nonmanifold_stars(surface, links, max_triangles(options.triangles_per_patch));
  const TriangleGroups small =
      group_small_regions(surface, links, glued, options.triangles_per_patch);

  // Merge the rest, then number the patches of small regions behind.
  const SeedClusters clusters =
      first_clusters(surface, links, glued, small, options, partition.patch_of);
  if (is_cancelled(0.5f)) return partition;
  if (clusters.count > 0) merge_clusters(surface, links, clusters, options, partition);
  for (std::uint32_t t = 0; small.count > 0 && t < surface.triangle_count(); ++t)
    if (small.of(t) != kNone) partition.patch_of[t] = partition.patch_count + small.of(t);
  partition.patch_count += small.count;

  if (is_cancelled(0.7f)) return partition;
  measure_rough(surface, links, partition);
  partition.border_edges = partition.rough_border_edges;
  partition.border_length = partition.rough_border_length;
  if (options.smooth) {
    const SmoothedPatches patches{partition.patch_of, partition.patch_count,
                                  max_triangles(options.triangles_per_patch)};
    const SmoothingReport shorter = smooth_borders(surface, links, patches, options.threads);
    partition.smoothing_rounds = shorter.rounds;
    partition.border_edges -= static_cast<std::uint64_t>(shorter.edges);
    partition.border_length -= shorter.length;
  }
  // What merging counted holds where triangles meet in pairs; smoothing keeps it.
  if (small.count > 0 || !links.nonmanifold().empty())
    partition.euler =
        euler_characteristics(surface, links, {partition.patch_of, partition.patch_count});
  for (const std::int32_t euler : partition.euler) partition.non_discs += euler != 1;
  return partition;
}

}  // namespace varifold
