// Greedy merging of clusters in rounds: best pairs that choose each other merge at once.
//
// Based on: [Birkholz2007] section 3 (equation 1).
// Differs: instead of one merge at a time in the order of a heap, a round merges all pairs that are
//   the best for each other and below a bound that grows, which gives nearly the same clusters and
//   runs in parallel; merges that would leave discs are put off.
#pragma once

#include <varifold/partition/cluster_graph.h>
#include <array>
#include <cstdint>
#include <vector>

namespace varifold {

/// Twice the square of the priority of equation (1) for a union of two clusters; monotone with it.
[[nodiscard]] inline float merge_cost(const ClusterShape& a, const ClusterShape& b, float common) {
  constexpr float kFourPi = 12.566370614f;
  const float outline = a.outline + b.outline - 2 * common;
  return outline * outline + kFourPi * (a.area + b.area);
}

struct MergeLimits {
  std::uint32_t clusters = 1;         ///< how many shall be left; never fewer
  std::uint32_t max_triangles = ~0u;  ///< in a union
  bool discs = true;                  ///< only unions that are no farther from discs than the parts
};

/// Clusters keep their numbers: a union has the lower one of its two parts.
class MergeRounds {
 public:
  MergeRounds(ClusterGraph graph, int threads);

  /// Merges until so many clusters are left, or nothing that is allowed. The same result for any
  /// number of threads. About O(n) for n clusters.
  void run(const MergeLimits& limits);

  /// Those that are left, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& alive() const { return alive_; }
  [[nodiscard]] const ClusterShape& shape(std::uint32_t alive) const {
    return graph_.shapes[alive];
  }
  /// The cluster that a cluster of the start is part of now.
  [[nodiscard]] std::uint32_t cluster_of(std::uint32_t first) const { return resolve(first); }

 private:
  static constexpr std::uint32_t kUnknown = kNone - 1;  // choose again

  // What a cluster would like to merge with.
  struct Choice {
    float cost = 0;
    std::uint32_t other = kUnknown;  // kNone: nothing is allowed
    std::uint32_t chosen_at = 0;     // the round; 0: never
    std::uint32_t changed_at = 0;    // the round of the last merge of the chooser
  };
  struct Pair {
    std::uint32_t a, b;
    float cost;
    std::uint32_t links, points;  // where the rows of the union begin
  };

  struct Found {
    std::vector<Pair> pairs, refused;
  };

  [[nodiscard]] std::uint32_t resolve(std::uint32_t cluster) const {
    while (into_[cluster] != cluster) cluster = into_[cluster];
    return cluster;
  }
  void choose_all(const MergeLimits& limits);
  [[nodiscard]] bool is_stale(std::uint32_t cluster) const;
  void note(std::uint32_t cluster);
  void refresh_links(std::uint32_t cluster);
  void choose(std::uint32_t cluster, const MergeLimits& limits);
  [[nodiscard]] float bound() const;
  [[nodiscard]] bool pair_up(const MergeLimits& limits, float bound);
  [[nodiscard]] bool is_allowed(std::uint32_t a, std::uint32_t b, bool discs) const;
  void refuse(std::uint32_t a, std::uint32_t b);
  [[nodiscard]] bool pair_cheapest(const MergeLimits& limits);
  void keep_cheapest(std::uint32_t wanted);
  void merge_pairs();
  void reserve_rows();
  void compact();
  void merge(const Pair& pair);
  void merge_links(const Pair& pair);
  [[nodiscard]] bool is_shared(std::uint32_t point, bool was_common);
  [[nodiscard]] std::uint32_t merge_points(const Pair& pair);

  ClusterGraph graph_;
  int threads_;
  std::uint32_t round_ = 0;
  std::vector<std::uint32_t> alive_;
  LargeVector<std::uint32_t> into_;  // itself, or the cluster that it was merged into
  LargeVector<Choice> choices_;
  std::array<LargeVector<std::uint8_t>, 2> noted_;  // by odd and even rounds
  std::vector<Pair> pairs_;
  std::vector<Found> found_;  // by pieces of alive_
  std::uint32_t used_links_ = 0, used_points_ = 0;
};

}  // namespace varifold
