#include <benchmarks/cluster_groups.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

namespace varifold::bench {
namespace {

// Vertices that a group shares with each of its neighbours.
using Shared = std::map<std::uint32_t, std::uint32_t>;

std::vector<Shared> find_shared(std::span<const std::vector<std::uint32_t>> clusters) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> uses;  // vertex, cluster
  for (std::uint32_t c = 0; c < clusters.size(); ++c)
    for (const std::uint32_t v : clusters[c]) uses.emplace_back(v, c);
  std::sort(uses.begin(), uses.end());
  std::vector<Shared> shared(clusters.size());
  for (std::size_t first = 0, end = 0; first < uses.size(); first = end) {
    while (end < uses.size() && uses[end].first == uses[first].first) ++end;
    for (std::size_t i = first; i < end; ++i)
      for (std::size_t j = first; j < end; ++j)
        if (i != j) ++shared[uses[i].second][uses[j].second];
  }
  return shared;
}

class Merging {
 public:
  Merging(std::span<const std::vector<std::uint32_t>> clusters, std::uint32_t wanted)
      : wanted_(wanted), most_(wanted + wanted / 3), shared_(find_shared(clusters)) {
    groups_.resize(clusters.size());
    for (std::uint32_t c = 0; c < clusters.size(); ++c) {
      groups_[c] = {c};
      by_size_.emplace(1, c);
    }
  }

  std::vector<std::vector<std::uint32_t>> run() {
    while (!by_size_.empty()) {
      const std::uint32_t group = by_size_.begin()->second;
      by_size_.erase(by_size_.begin());
      const std::uint32_t other = best_neighbor(group);
      if (other != group) merge(group, other);
    }
    std::erase_if(groups_, [](const auto& group) { return group.empty(); });
    return std::move(groups_);
  }

 private:
  // The group itself where there is none.
  [[nodiscard]] std::uint32_t best_neighbor(std::uint32_t group) const {
    std::uint32_t best = group;
    double most = 0;
    for (const auto& [other, shared] : shared_[group]) {
      if (groups_[group].size() + groups_[other].size() > most_) continue;
      const double worth = shared / std::sqrt(static_cast<double>(groups_[other].size()));
      if (worth > most) most = worth, best = other;
    }
    return best;
  }
  void merge(std::uint32_t from, std::uint32_t into) {
    by_size_.erase({groups_[into].size(), into});
    groups_[into].insert(groups_[into].end(), groups_[from].begin(), groups_[from].end());
    groups_[from].clear();
    for (const auto& [other, shared] : shared_[from]) {
      shared_[other].erase(from);
      if (other == into) continue;
      shared_[other][into] += shared;
      shared_[into][other] += shared;
    }
    shared_[from].clear();
    if (groups_[into].size() < wanted_) by_size_.emplace(groups_[into].size(), into);
  }

  std::size_t wanted_, most_;
  std::vector<Shared> shared_;
  std::vector<std::vector<std::uint32_t>> groups_;
  std::set<std::pair<std::size_t, std::uint32_t>> by_size_;  // groups that are too small
};

}  // namespace

std::vector<std::vector<std::uint32_t>> group_clusters(
    std::span<const std::vector<std::uint32_t>> clusters, std::uint32_t wanted) {
  return Merging(clusters, wanted).run();
}

}  // namespace varifold::bench
