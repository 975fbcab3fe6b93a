#include <varifold/partition/seed_clusters.h>

#include <varifold/base/parallel.h>
#include <varifold/partition/vertex_fans.h>
#include <algorithm>
#include <array>

namespace varifold {

namespace {

// Clusters stay within pieces of so many triangles, so that pieces are independent.
constexpr std::uint32_t kPiece = 1u << 15;
constexpr std::uint32_t kMaxStar = 8;
constexpr std::uint32_t kMinStar = 4;
constexpr std::uint32_t kMaxSeed = 10;

class Seeder {
 public:
  Seeder(const SurfaceView& surface, const EdgeLinks& links, std::span<std::uint32_t> cluster_of,
         std::uint32_t begin)
      : surface_(surface),
        links_(links),
        cluster_of_(cluster_of),
        begin_(begin),
        end_(std::min(begin + kPiece, surface.triangle_count())),
        is_old_(end_ - begin_) {
    for (std::uint32_t t = begin_; t < end_; ++t) is_old_[t - begin_] = cluster_of[t] != kNone;
  }

  // Numbers the clusters of the piece from 0 on; returns how many there are.
  std::uint32_t run() {
    for (std::uint32_t t = begin_; t < end_; ++t)
      for (std::uint32_t i = 0; i < 3 && is_free(t); ++i) try_star(3 * t + i);
    for (std::uint32_t t = begin_; t < end_; ++t)
      if (is_free(t)) attach(t);
    for (std::uint32_t t = begin_; t < end_; ++t)
      if (is_free(t)) attach_or_found(t);
    return count_;
  }

 private:
  [[nodiscard]] bool is_free(std::uint32_t triangle) const {
    return triangle >= begin_ && triangle < end_ && cluster_of_[triangle] == kNone;
  }
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
    for (std::uint32_t i = 0; i < size; ++i) cluster_of_[star[i]] = count_;
    ++count_;
    sizes_.push_back(size);
  }

  // Gives a triangle to the neighbouring cluster at its longest edge that stays a disc by that.
  bool attach(std::uint32_t triangle) {
    std::uint32_t best = kNone;
    float longest = -1;
    for (std::uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
      const std::uint32_t g = links_.across_in_material(h);
      if (g == kNone || !is_new(g / 3)) continue;
      const std::uint32_t cluster = cluster_of_[g / 3];
      if (sizes_[cluster] >= kMaxSeed) continue;
      // The sum of the extents will do, and has no squares that run over.
      const Vec3 edge = glm::abs(0.5f * surface_.positions[corner(next_in_triangle(h))] -
                                 0.5f * surface_.positions[corner(h)]);
      const float length = edge.x + edge.y + edge.z;
      if (length <= longest || !stays_disc(h, cluster)) continue;
      longest = length;
      best = cluster;
    }
    if (best == kNone) return false;
    cluster_of_[triangle] = best;
    ++sizes_[best];
    return true;
  }

  void attach_or_found(std::uint32_t triangle) {
    if (attach(triangle)) return;
    cluster_of_[triangle] = count_++;
    sizes_.push_back(1);
  }

  // Whether the triangle of h and a cluster across h have that edge in common and nothing else, or
  // just another edge.
  [[nodiscard]] bool stays_disc(std::uint32_t h, std::uint32_t cluster) const {
    const std::uint32_t next = next_in_triangle(h), last = next_in_triangle(next);
    const auto is_common = [&](std::uint32_t edge) {
      const std::uint32_t g = links_.across_in_material(edge);
      return g != kNone && is_new(g / 3) && cluster_of_[g / 3] == cluster;
    };
    const bool other = is_common(next), another = is_common(last);
    if (other || another) return other != another;
    const std::uint32_t apex = corner(last);
    for (const std::uint32_t first : {next, last})
      for (std::uint32_t spoke = first;;) {
        const std::uint32_t g = links_.across_in_material(spoke);
        if (g == kNone) break;
        if (g / 3 == h / 3) return true;
        if (is_new(g / 3) && cluster_of_[g / 3] == cluster) return false;
        spoke = other_spoke(surface_, g, apex);
      }
    return true;
  }
  // Whether the piece has given the triangle to a cluster.
  [[nodiscard]] bool is_new(std::uint32_t triangle) const {
    return triangle >= begin_ && triangle < end_ && !is_old_[triangle - begin_] &&
           cluster_of_[triangle] != kNone;
  }

  const SurfaceView& surface_;
  const EdgeLinks& links_;
  std::span<std::uint32_t> cluster_of_;
  std::uint32_t begin_, end_, count_ = 0;
  std::vector<std::uint8_t> is_old_;  // per triangle of the piece: not ours
  std::vector<std::uint32_t> sizes_;  // per cluster
};

}  // namespace

std::uint32_t seed_clusters(const SurfaceView& surface, const EdgeLinks& links,
                            std::span<std::uint32_t> cluster_of, std::uint32_t count, int threads) {
  const std::uint32_t n = surface.triangle_count();
  std::vector<std::uint32_t> counts((n + kPiece - 1) / kPiece);
  std::vector<std::uint8_t> is_old(n);
  parallel_for(threads, n, kPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) is_old[t] = cluster_of[t] != kNone;
    Seeder seeder(surface, links, cluster_of, static_cast<std::uint32_t>(begin));
    counts[begin / kPiece] = seeder.run();
  });
  for (std::uint32_t& c : counts) {
    const std::uint32_t first = count;
    count += c;
    c = first;
  }
  parallel_for(threads, n, kPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      if (!is_old[t]) cluster_of[t] += counts[begin / kPiece];
  });
  return count;
}

}  // namespace varifold
