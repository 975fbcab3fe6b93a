#include <varifold/partition/seed_clusters.h>

#include <varifold/base/parallel.h>
#include <varifold/partition/cluster_graph.h>
#include <varifold/partition/merge_rounds.h>
#include <varifold/partition/vertex_fans.h>
#include <algorithm>
#include <array>

namespace varifold {

namespace {

// Clusters stay within pieces of so many triangles: pieces are independent, and what is known of
// one stays in a cache.
constexpr std::uint32_t kPiece = 1u << 14;
constexpr std::uint32_t kMaxStar = 8;
constexpr std::uint32_t kMinStar = 4;
constexpr std::uint32_t kMaxSeed = 10;

class Seeder {
 public:
  // Of the triangles of a piece, those whose `cluster_of` is kNone.
  Seeder(const SurfaceView& surface, const EdgeLinks& links,
         std::span<const std::uint32_t> cluster_of, std::uint32_t begin, std::uint32_t grow_to)
      : surface_(surface),
        links_(links),
        begin_(begin),
        seed_of_(std::min<std::size_t>(kPiece, surface.triangle_count() - begin)),
        grow_to_(grow_to) {
    for (std::uint32_t i = 0; i < seed_of_.size(); ++i)
      seed_of_[i] = cluster_of[begin_ + i] == kNone ? kFree : kNone;
  }

  // Numbers the clusters of the piece from 0 on; returns how many there are.
  std::uint32_t run() {
    const auto end = static_cast<std::uint32_t>(begin_ + seed_of_.size());
    for (std::uint32_t t = begin_; t < end; ++t)
      for (std::uint32_t i = 0; i < 3 && is_free(t); ++i) try_star(3 * t + i);
    for (std::uint32_t t = begin_; t < end; ++t)
      if (is_free(t)) attach(t);
    for (std::uint32_t t = begin_; t < end; ++t)
      if (is_free(t)) attach_or_found(t);
    return count_;
  }

  /// Per triangle of the piece; kNone: none.
  [[nodiscard]] std::span<const std::uint32_t> seeds() const { return seed_of_; }

 private:
  static constexpr std::uint32_t kFree = kNone - 1;

  // kNone: of no seed, and not to be; so are all other pieces.
  [[nodiscard]] std::uint32_t seed_of(std::uint32_t triangle) const {
    const std::uint32_t at = triangle - begin_;
    return at < seed_of_.size() ? seed_of_[at] : kNone;
  }
  [[nodiscard]] bool is_free(std::uint32_t triangle) const { return seed_of(triangle) == kFree; }
  [[nodiscard]] std::uint32_t corner(std::uint32_t half_edge) const {
    return surface_.corners[half_edge];
  }

  // Takes all triangles around the point that a half-edge starts at, if they are free.
  void try_star(std::uint32_t half_edge) {
    const std::uint32_t center = corner(half_edge);
    std::array<std::uint32_t, kMaxStar> star{}, rim{};
    std::uint32_t size = 0;
    for (std::uint32_t h = half_edge;;) {
      // Leave the triangle by the spoke at its point `out`, which the half-edge h may start at.
      if (size == kMaxStar) return;
      const std::uint32_t out = other_end(surface_, h, center);
      star[size] = h / 3;
      rim[size++] = out;
      const std::uint32_t g = links_.across_in_material(h);
      if (g == kNone) return;
      if (g / 3 == half_edge / 3) break;
      if (!is_free(g / 3)) return;
      h = other_spoke(surface_, g, center);
    }
    if (size < kMinStar) return;
    for (std::uint32_t i = 1; i < size; ++i)
      for (std::uint32_t k = 0; k < i; ++k)
        if (rim[i] == rim[k]) return;
    for (std::uint32_t i = 0; i < size; ++i) seed_of_[star[i] - begin_] = count_;
    sizes_.push_back(size);
    members_.assign(star.begin(), star.begin() + size);
    grow();
    ++count_;
  }

  // Adds what is free around the last seed, in order of the distance from its middle.
  void grow() {
    for (std::size_t i = 0; i < members_.size(); ++i)
      for (std::uint32_t h = 3 * members_[i]; h < 3 * members_[i] + 3; ++h) {
        if (members_.size() >= grow_to_) return;
        const std::uint32_t g = links_.across_in_material(h);
        if (g == kNone || !is_free(g / 3) || !stays_disc(g, count_)) continue;
        seed_of_[g / 3 - begin_] = count_;
        ++sizes_[count_];
        members_.push_back(g / 3);
      }
  }

  // Gives a triangle to the neighbouring cluster at its longest edge that stays a disc by that.
  bool attach(std::uint32_t triangle) {
    std::uint32_t best = kNone;
    float longest = -1;
    for (std::uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
      const std::uint32_t g = links_.across_in_material(h);
      if (g == kNone) continue;
      const std::uint32_t cluster = seed_of(g / 3);
      if (cluster >= kFree || sizes_[cluster] >= std::max(kMaxSeed, 2 * grow_to_)) continue;
      // The sum of the extents will do, and has no squares that run over.
      const Vec3 edge = glm::abs(0.5f * surface_.positions[corner(next_in_triangle(h))] -
                                 0.5f * surface_.positions[corner(h)]);
      const float length = edge.x + edge.y + edge.z;
      if (length <= longest || !stays_disc(h, cluster)) continue;
      longest = length;
      best = cluster;
    }
    if (best == kNone) return false;
    seed_of_[triangle - begin_] = best;
    ++sizes_[best];
    return true;
  }

  void attach_or_found(std::uint32_t triangle) {
    if (attach(triangle)) return;
    seed_of_[triangle - begin_] = count_++;
    sizes_.push_back(1);
  }

  // Whether the triangle of h and a cluster across h have that edge in common and nothing else, or
  // just another edge.
  [[nodiscard]] bool stays_disc(std::uint32_t h, std::uint32_t cluster) const {
    const std::uint32_t next = next_in_triangle(h), last = next_in_triangle(next);
    const auto is_common = [&](std::uint32_t edge) {
      const std::uint32_t g = links_.across_in_material(edge);
      return g != kNone && seed_of(g / 3) == cluster;
    };
    const bool other = is_common(next), another = is_common(last);
    if (other || another) return other != another;
    const std::uint32_t apex = corner(last);
    for (const std::uint32_t first : {next, last})
      for (std::uint32_t spoke = first;;) {
        const std::uint32_t g = links_.across_in_material(spoke);
        if (g == kNone) break;
        if (g / 3 == h / 3) return true;
        if (seed_of(g / 3) == cluster) return false;
        spoke = other_spoke(surface_, g, apex);
      }
    return true;
  }

  const SurfaceView& surface_;
  const EdgeLinks& links_;
  std::uint32_t begin_, count_ = 0;
  std::vector<std::uint32_t> seed_of_;  // per triangle of the piece
  std::vector<std::uint32_t> sizes_;    // per seed
  std::vector<std::uint32_t> members_;  // of the last seed
  std::uint32_t grow_to_;
};

// Merges the seeds of a piece by themselves, as far as it goes. Returns the areas of the clusters.
std::vector<float> merge_seeds(const SurfaceView& surface, const EdgeLinks& links,
                               const ClusterMap& map, const SeedOptions& options,
                               std::span<std::uint32_t> cluster_of) {
  const auto size = static_cast<std::uint32_t>(map.cluster_of.size());
  const GraphOptions graph{.count_clusters_at = false, .unit = options.unit, .threads = 1};
  MergeRounds rounds(build_cluster_graph(surface, links, map, graph), 1);
  rounds.run({.clusters = size / options.triangles + 1, .max_triangles = 2 * options.triangles});
  std::vector<float> areas;
  std::vector<std::uint32_t> number(map.count);
  for (const std::uint32_t c : rounds.alive()) {
    number[c] = static_cast<std::uint32_t>(areas.size());
    areas.push_back(rounds.shape(c).area);
  }
  for (std::uint32_t c = 0; c < map.count; ++c) number[c] = number[rounds.cluster_of(c)];
  for (std::uint32_t i = 0; i < size; ++i)
    if (map.cluster_of[i] != kNone) cluster_of[i] = number[map.cluster_of[i]];
  return areas;
}

}  // namespace

SeedClusters seed_clusters(const SurfaceView& surface, const EdgeLinks& links,
                           const SeedOptions& options, std::span<std::uint32_t> cluster_of,
                           std::uint32_t count) {
  const std::uint32_t n = surface.triangle_count();
  std::vector<std::vector<float>> areas((n + kPiece - 1) / kPiece);
  std::vector<std::uint8_t> is_old(n);
  parallel_for(options.threads, n, kPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) is_old[t] = cluster_of[t] != kNone;
    const auto first = static_cast<std::uint32_t>(begin);
    Seeder seeder(surface, links, cluster_of, first, options.grow_to);
    const std::uint32_t seeds = seeder.run();
    const ClusterMap map{seeder.seeds(), seeds, first};
    areas[begin / kPiece] =
        merge_seeds(surface, links, map, options, cluster_of.subspan(begin, end - begin));
  });

  // Number the clusters of all pieces one after the other.
  SeedClusters result;
  std::vector<std::uint32_t> first_of(areas.size());
  for (std::size_t p = 0; p < areas.size(); ++p) {
    first_of[p] = count + static_cast<std::uint32_t>(result.areas.size());
    result.areas.insert(result.areas.end(), areas[p].begin(), areas[p].end());
  }
  result.count = count + static_cast<std::uint32_t>(result.areas.size());
  parallel_for(options.threads, n, kPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      if (!is_old[t]) cluster_of[t] += first_of[begin / kPiece];
  });
  return result;
}

}  // namespace varifold
