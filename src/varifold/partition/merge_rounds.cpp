#include <varifold/partition/merge_rounds.h>

#include <varifold/base/parallel.h>
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <limits>
#include <utility>

namespace varifold {

namespace {

constexpr std::size_t kGrain = 8192;
constexpr std::uint32_t kBoundSamples = 4096;
constexpr float kBoundQuantile = 0.75f;
constexpr std::uint32_t kLongRow = 64;

// Breaks ties between pairs of equal cost in a way that does not run along a row of clusters.
std::uint32_t pair_hash(std::uint32_t a, std::uint32_t b) {
  std::uint64_t x = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return static_cast<std::uint32_t>(x >> 32);
}

// Adds `link` to another one with the same neighbour.
void combine(ClusterLink& into, const ClusterLink& link) {
  const std::uint32_t edges = into.edge_count() + link.edge_count();
  if (edges == 0)
    into.length = std::max(into.length, link.length);
  else
    into.length = (into.edge_count() ? into.length : 0) + (link.edge_count() ? link.length : 0);
  into.edges = edges;
}

void combine_equal(std::span<ClusterLink> row, std::uint32_t& count) {
  std::stable_sort(row.begin(), row.begin() + count,
                   [](const ClusterLink& a, const ClusterLink& b) { return a.other < b.other; });
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (kept > 0 && row[kept - 1].other == row[i].other)
      combine(row[kept - 1], row[i]);
    else
      row[kept++] = row[i];
  }
  count = kept;
}

const ClusterLink* find_link(const ClusterGraph& graph, std::uint32_t from, std::uint32_t to) {
  for (const ClusterLink& link : graph.links_of(from))
    if (link.other == to) return &link;
  return nullptr;
}

void refuse(ClusterGraph& graph, std::uint32_t from, std::uint32_t to) {
  for (ClusterLink& link : graph.links_of(from))
    if (link.other == to) link.edges |= ClusterLink::kRefused;
}

std::uint32_t count_common(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  std::uint32_t common = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const std::uint32_t x = a[i], y = b[j];
    common += x == y;
    i += x <= y;
    j += y <= x;
  }
  return common;
}

std::int32_t euler_of_union(const ClusterGraph& graph, std::uint32_t a, std::uint32_t b,
                            std::uint32_t edges) {
  const std::uint32_t common = count_common(graph.points_of(a), graph.points_of(b));
  return graph.shapes[a].euler + graph.shapes[b].euler - static_cast<std::int32_t>(common - edges);
}

}  // namespace

MergeRounds::MergeRounds(ClusterGraph graph, int threads)
    : graph_(std::move(graph)), threads_(threads), cluster_of_(graph_.size()) {
  for (std::uint32_t c = 0; c < graph_.size(); ++c) cluster_of_[c] = c;
}

void MergeRounds::run(const MergeLimits& limits) {
  const std::uint32_t target = std::max(limits.clusters, 1u);
  while (graph_.size() > target) {
    choose(limits);
    refused_any_ = false;
    std::uint32_t pairs = pair_up(limits, bound());
    if (pairs == 0 && !refused_any_)
      pairs = pair_up(limits, std::numeric_limits<float>::infinity());
    if (pairs == 0) {
      if (refused_any_) continue;
      if (!pair_cheapest(limits)) {
        if (refused_any_) continue;
        break;
      }
      pairs = 1;
    }
    keep_cheapest(graph_.size() - target, pairs);
    contract();
  }
}

// Every cluster chooses its best neighbour.
void MergeRounds::choose(const MergeLimits& limits) {
  choices_.resize(graph_.size());
  parallel_for(threads_, graph_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (auto c = static_cast<std::uint32_t>(begin); c < end; ++c) {
      const ClusterShape& shape = graph_.shapes[c];
      Choice best{std::numeric_limits<float>::infinity(), kNone};
      for (const ClusterLink& link : std::as_const(graph_).links_of(c)) {
        const ClusterShape& other = graph_.shapes[link.other];
        if ((limits.discs && link.refused()) ||
            shape.triangles + other.triangles > limits.max_triangles)
          continue;
        const float cost = merge_cost(shape, other, link.length);
        if (cost < best.cost || (cost == best.cost && best.other != kNone &&
                                 pair_hash(c, link.other) < pair_hash(c, best.other)))
          best = {cost, link.other};
      }
      choices_[c] = best;
    }
  });
}

// The cost that a good part of the choices stays below.
float MergeRounds::bound() const {
  const std::uint32_t stride = graph_.size() / kBoundSamples + 1;
  std::vector<float> costs;
  for (std::uint32_t c = 0; c < graph_.size(); c += stride)
    if (choices_[c].other != kNone) costs.push_back(choices_[c].cost);
  if (costs.empty()) return std::numeric_limits<float>::infinity();
  const auto at = static_cast<std::size_t>(kBoundQuantile * static_cast<float>(costs.size() - 1));
  std::nth_element(costs.begin(), costs.begin() + static_cast<std::ptrdiff_t>(at), costs.end());
  return costs[at];
}

bool MergeRounds::try_pair(std::uint32_t a, std::uint32_t b, bool discs) {
  if (discs) {
    const std::int32_t euler = euler_of_union(graph_, a, b, find_link(graph_, a, b)->edge_count());
    const std::int32_t before =
        std::abs(1 - graph_.shapes[a].euler) + std::abs(1 - graph_.shapes[b].euler);
    if (std::abs(1 - euler) > before) {
      refuse(graph_, a, b);
      refuse(graph_, b, a);
      return false;
    }
  }
  mates_[a] = b;
  mates_[b] = a;
  return true;
}

// Pairs the clusters that choose each other at a cost up to the bound. Returns how many pairs.
std::uint32_t MergeRounds::pair_up(const MergeLimits& limits, float bound) {
  mates_.assign(graph_.size(), kNone);
  std::atomic<std::uint32_t> pairs{0};
  std::atomic<bool> refused{false};
  parallel_for(threads_, graph_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::uint32_t found = 0, tried = 0;
    for (auto c = static_cast<std::uint32_t>(begin); c < end; ++c) {
      const Choice& choice = choices_[c];
      if (choice.other == kNone || choice.other < c || choice.cost > bound ||
          choices_[choice.other].other != c)
        continue;
      ++tried;
      found += try_pair(c, choice.other, limits.discs);
    }
    pairs += found;
    if (found < tried) refused = true;
  });
  refused_any_ |= refused;
  return pairs;
}

// Rounding may leave a ring of choices without a pair; then the cheapest one merges.
bool MergeRounds::pair_cheapest(const MergeLimits& limits) {
  std::uint32_t best = kNone;
  for (std::uint32_t c = 0; c < graph_.size(); ++c)
    if (choices_[c].other != kNone && (best == kNone || choices_[c].cost < choices_[best].cost))
      best = c;
  if (best == kNone) return false;
  const bool paired = try_pair(best, choices_[best].other, limits.discs);
  refused_any_ |= !paired;
  return paired;
}

void MergeRounds::keep_cheapest(std::uint32_t wanted, std::uint32_t pairs) {
  if (pairs <= wanted) return;
  std::vector<std::pair<float, std::uint32_t>> sorted;
  for (std::uint32_t c = 0; c < graph_.size(); ++c)
    if (mates_[c] != kNone && c < mates_[c]) sorted.emplace_back(choices_[c].cost, c);
  std::nth_element(sorted.begin(), sorted.begin() + wanted, sorted.end());
  for (std::size_t i = wanted; i < sorted.size(); ++i) {
    const std::uint32_t c = sorted[i].second;
    mates_[mates_[c]] = kNone;
    mates_[c] = kNone;
  }
}

void MergeRounds::number_merged() {
  renumber_.resize(graph_.size());
  merged_count_ = 0;
  for (std::uint32_t c = 0; c < graph_.size(); ++c)
    renumber_[c] = mates_[c] < c ? renumber_[mates_[c]] : merged_count_++;
  for (std::uint32_t& cluster : cluster_of_) cluster = renumber_[cluster];
}

// Makes the graph of the merged clusters.
void MergeRounds::contract() {
  number_merged();
  ClusterGraph merged;
  merged.unit = graph_.unit;
  merged.shapes.resize(merged_count_);
  merged.link_rows.resize(merged_count_);
  merged.point_rows.resize(merged_count_);
  std::uint32_t links = 0, points = 0;
  for (std::uint32_t c = 0; c < graph_.size(); ++c) {
    if (mates_[c] < c) continue;
    merged.link_rows[renumber_[c]].begin = links;
    merged.point_rows[renumber_[c]].begin = points;
    links += graph_.link_rows[c].count;
    points += graph_.point_rows[c].count;
    if (mates_[c] == kNone) continue;
    links += graph_.link_rows[mates_[c]].count;
    points += graph_.point_rows[mates_[c]].count;
  }
  merged.links.resize(links);
  merged.points.resize(points);
  parallel_for(threads_, graph_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (auto c = static_cast<std::uint32_t>(begin); c < end; ++c)
      if (mates_[c] > c) merge_rows(merged, c, mates_[c]);
  });
  merged.clusters_at = std::move(graph_.clusters_at);
  graph_ = std::move(merged);
}

// Writes what becomes of cluster a, with its mate b or alone (kNone).
void MergeRounds::merge_rows(ClusterGraph& merged, std::uint32_t a, std::uint32_t b) {
  const ClusterGraph& graph = graph_;
  const std::uint32_t self = renumber_[a];
  ClusterShape& shape = merged.shapes[self];
  shape = graph.shapes[a];
  Row& row = merged.link_rows[self];
  ClusterLink* links = merged.links.data() + row.begin;
  const bool is_long =
      graph.link_rows[a].count + (b == kNone ? 0 : graph.link_rows[b].count) > kLongRow;
  const auto add = [&](ClusterLink link) {
    const bool changes = b != kNone || mates_[link.other] != kNone;
    if (changes) link.edges &= ~ClusterLink::kRefused;
    link.other = renumber_[link.other];
    if (link.other == self) return;
    for (std::uint32_t i = 0; !is_long && i < row.count; ++i)
      if (links[i].other == link.other) return combine(links[i], link);
    links[row.count++] = link;
  };
  for (const ClusterLink& link : graph.links_of(a)) add(link);
  if (b != kNone)
    for (const ClusterLink& link : graph.links_of(b)) add(link);
  if (is_long) combine_equal({links, row.count}, row.count);

  // A point that no other cluster has is common to none: whether it is dropped now or, where
  // another thread is about to lower its count, later, makes no difference to any result.
  Row& point_row = merged.point_rows[self];
  std::uint32_t* points = merged.points.data() + point_row.begin;
  const auto count_at = [&](std::uint32_t point) {
    return std::atomic_ref<std::uint32_t>(graph_.clusters_at[point]);
  };
  const auto keep = [&](std::uint32_t point) {
    if (count_at(point).load(std::memory_order_relaxed) > 1) points[point_row.count++] = point;
  };
  const std::span<const std::uint32_t> p = graph.points_of(a);
  if (b == kNone) {
    for (const std::uint32_t point : p) keep(point);
    return;
  }
  const std::span<const std::uint32_t> q = graph.points_of(b);
  std::uint32_t common = 0;
  for (std::size_t i = 0, j = 0; i < p.size() || j < q.size();) {
    const std::uint32_t x = i < p.size() ? p[i] : kNone, y = j < q.size() ? q[j] : kNone;
    if (x == y) {
      ++common;
      count_at(x).fetch_sub(1, std::memory_order_relaxed);
    }
    keep(std::min(x, y));
    i += x <= y;
    j += y <= x;
  }
  const ClusterLink* link = find_link(graph, a, b);
  const ClusterShape& other = graph.shapes[b];
  shape.area += other.area;
  shape.triangles += other.triangles;
  shape.outline = shape.outline + other.outline - 2 * std::max(link->length, 0.0f);
  shape.outline = std::max(shape.outline, 0.0f);
  shape.euler += other.euler - static_cast<std::int32_t>(common - link->edge_count());
}

}  // namespace varifold
