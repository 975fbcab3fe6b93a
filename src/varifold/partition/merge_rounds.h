// Greedy merging of clusters in rounds: best pairs that choose each other merge at once.
//
// Based on: [Birkholz2007] section 3 (equation 1).
// Differs: instead of one merge at a time in the order of a heap, a round merges all pairs that are
//   the best for each other and below a bound that grows, which gives nearly the same clusters and
//   runs in parallel; merges that would leave discs are put off.
#pragma once

#include <varifold/partition/cluster_graph.h>
#include <cstdint>
#include <utility>
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

class MergeRounds {
 public:
  MergeRounds(ClusterGraph graph, int threads);

  /// Merges until so many clusters are left, or nothing that is allowed. Clusters are numbered by
  /// their lowest member. About O(n) for n clusters.
  void run(const MergeLimits& limits);

  [[nodiscard]] const ClusterGraph& graph() const { return graph_; }
  /// Hands the graph on; nothing may be run afterwards.
  [[nodiscard]] ClusterGraph take_graph() { return std::move(graph_); }
  /// Per cluster of the graph at the start: its cluster now.
  [[nodiscard]] const std::vector<std::uint32_t>& cluster_of() const { return cluster_of_; }

 private:
  struct Choice {
    float cost;
    std::uint32_t other;  // kNone: nothing allowed
  };

  void choose(const MergeLimits& limits);
  [[nodiscard]] float bound() const;
  [[nodiscard]] std::uint32_t pair_up(const MergeLimits& limits, float bound);
  [[nodiscard]] bool try_pair(std::uint32_t a, std::uint32_t b, bool discs);
  void keep_cheapest(std::uint32_t wanted, std::uint32_t pairs);
  [[nodiscard]] bool pair_cheapest(const MergeLimits& limits);
  void contract();
  void number_merged();
  void merge_rows(ClusterGraph& merged, std::uint32_t a, std::uint32_t b);

  ClusterGraph graph_;
  int threads_;
  std::vector<std::uint32_t> cluster_of_;
  LargeVector<Choice> choices_;
  LargeVector<std::uint32_t> mates_;     // kNone: stays
  LargeVector<std::uint32_t> renumber_;  // to the clusters after the round
  std::uint32_t merged_count_ = 0;
  bool refused_any_ = false;
};

}  // namespace varifold
