#include <varifold/partition/merge_rounds.h>

#include <varifold/base/parallel.h>
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <limits>
#include <utility>

namespace varifold {

namespace {

constexpr std::size_t kGrain = 4096;
constexpr std::uint32_t kBoundSamples = 256;
constexpr float kBoundQuantile = 0.25f;
constexpr float kClearlyMore = 1.001f;  // than rounding does
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

const ClusterLink& find_link(const ClusterGraph& graph, std::uint32_t from, std::uint32_t to) {
  const ClusterLink* link = graph.links_of(from).data();
  while (link->other != to) ++link;
  return *link;
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

}  // namespace

MergeRounds::MergeRounds(ClusterGraph graph, int threads)
    : graph_(std::move(graph)),
      threads_(threads),
      alive_(graph_.size()),
      into_(graph_.size()),
      choices_(graph_.size()),
      noted_{LargeVector<std::uint8_t>(graph_.size()), LargeVector<std::uint8_t>(graph_.size())},
      used_links_(static_cast<std::uint32_t>(graph_.links.size())),
      used_points_(static_cast<std::uint32_t>(graph_.points.size())) {
  for (std::uint32_t c = 0; c < graph_.size(); ++c) into_[c] = alive_[c] = c;
}

void MergeRounds::run(const MergeLimits& limits) {
  const std::uint32_t target = std::max(limits.clusters, 1u);
  for (const std::uint32_t c : alive_) choices_[c].other = kUnknown;
  while (alive_.size() > target) {
    ++round_;
    choose_all(limits);
    const bool refused_none = pair_up(limits, bound());
    if (pairs_.empty() && refused_none && !pair_cheapest(limits)) break;
    if (pairs_.empty()) continue;
    keep_cheapest(static_cast<std::uint32_t>(alive_.size()) - target);
    merge_pairs();
  }
}

// A choice holds until what was chosen is merged.
bool MergeRounds::is_stale(std::uint32_t cluster) const {
  const Choice& choice = choices_[cluster];
  if (noted_[(round_ - 1) % 2][cluster]) return true;
  if (choice.other == kUnknown) return true;
  if (choice.other == kNone) return true;  // the neighbours may have changed
  return into_[choice.other] != choice.other ||
         choices_[choice.other].changed_at >= choice.chosen_at;
}

// Lets every cluster choose its best neighbour that has not, or whose choice is gone, or that was
// noted: two of its neighbours have become one, or one that has changed asks for it.
void MergeRounds::choose_all(const MergeLimits& limits) {
  parallel_for(threads_, alive_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t cluster = alive_[i];
      if (is_stale(cluster)) choose(cluster, limits);
      noted_[(round_ - 1) % 2][cluster] = 0;
    }
  });
}

// Names the neighbours by what they have been merged into.
void MergeRounds::refresh_links(std::uint32_t cluster) {
  Row& row = graph_.link_rows[cluster];
  ClusterLink* links = graph_.links.data() + row.begin;
  const std::uint32_t since = choices_[cluster].chosen_at;
  const bool is_long = row.count > kLongRow;
  const bool is_new = choices_[cluster].changed_at + 1 == round_;
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < row.count; ++i) {
    ClusterLink link = links[i];
    link.other = resolve(link.other);
    if (link.other == cluster) continue;
    if (choices_[link.other].changed_at >= since) link.edges &= ~ClusterLink::kRefused;
    std::uint32_t at = is_long ? kept : 0;
    while (at < kept && links[at].other != link.other) ++at;
    if (at == kept) {
      links[kept++] = link;
      continue;
    }
    combine(links[at], link);
    if (is_new) note(link.other);
  }
  row.count = kept;
  if (is_long) combine_equal({links, kept}, row.count);
}

// Lets a cluster choose again in the next round, whoever gets there first in this one.
void MergeRounds::note(std::uint32_t cluster) {
  std::atomic_ref<std::uint8_t>(noted_[round_ % 2][cluster]).store(1, std::memory_order_relaxed);
}

void MergeRounds::choose(std::uint32_t cluster, const MergeLimits& limits) {
  refresh_links(cluster);
  const ClusterShape& shape = graph_.shapes[cluster];
  Choice& choice = choices_[cluster];
  choice.cost = std::numeric_limits<float>::infinity();
  choice.other = kNone;
  choice.chosen_at = round_;
  for (const ClusterLink& link : std::as_const(graph_).links_of(cluster)) {
    const ClusterShape& other = graph_.shapes[link.other];
    if ((limits.discs && link.refused()) ||
        shape.triangles + other.triangles > limits.max_triangles)
      continue;
    const float cost = merge_cost(shape, other, link.length);
    if (cost < choice.cost || (cost == choice.cost && choice.other != kNone &&
                               pair_hash(cluster, link.other) < pair_hash(cluster, choice.other))) {
      choice.cost = cost;
      choice.other = link.other;
    }
  }
}

// The cost that some part of the choices stays below.
float MergeRounds::bound() const {
  const std::size_t stride = alive_.size() / kBoundSamples + 1;
  std::vector<float> costs;
  costs.reserve(kBoundSamples);
  for (std::size_t i = 0; i < alive_.size(); i += stride)
    if (choices_[alive_[i]].other != kNone) costs.push_back(choices_[alive_[i]].cost);
  if (costs.empty()) return std::numeric_limits<float>::infinity();
  const auto at = static_cast<std::ptrdiff_t>(kBoundQuantile * static_cast<float>(costs.size()));
  std::nth_element(costs.begin(), costs.begin() + at, costs.end());
  return costs[at];
}

// Whether the union is no farther from a disc than the parts.
bool MergeRounds::is_allowed(std::uint32_t a, std::uint32_t b, bool discs) const {
  if (!discs) return true;
  const std::int32_t p = graph_.shapes[a].euler, q = graph_.shapes[b].euler;
  const std::uint32_t points = count_common(graph_.points_of(a), graph_.points_of(b));
  const auto common = static_cast<std::int32_t>(points - find_link(graph_, a, b).edge_count());
  return std::abs(1 - (p + q - common)) <= std::abs(1 - p) + std::abs(1 - q);
}

// Lists the pairs that choose each other at a cost up to the bound. False where one was refused.
bool MergeRounds::pair_up(const MergeLimits& limits, float bound) {
  found_.resize((alive_.size() + kGrain - 1) / kGrain);
  parallel_for(threads_, alive_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    Found& found = found_[begin / kGrain];
    found.pairs.clear();
    found.refused.clear();
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t c = alive_[i];
      const Choice& choice = choices_[c];
      if (choice.cost > bound || choice.other == kNone) continue;
      const Choice& answer = choices_[choice.other];
      if (answer.other != c && answer.cost > kClearlyMore * choice.cost) note(choice.other);
      if (answer.other != c || choice.other < c) continue;
      const Pair pair{c, choice.other, choice.cost, 0, 0};
      (is_allowed(c, choice.other, limits.discs) ? found.pairs : found.refused).push_back(pair);
    }
  });
  pairs_.clear();
  bool refused_none = true;
  for (const Found& found : found_) {
    pairs_.insert(pairs_.end(), found.pairs.begin(), found.pairs.end());
    for (const Pair& pair : found.refused) refuse(pair.a, pair.b);
    refused_none &= found.refused.empty();
  }
  return refused_none;
}

// The two will not choose each other again before one of them is merged.
void MergeRounds::refuse(std::uint32_t a, std::uint32_t b) {
  for (ClusterLink& link : graph_.links_of(a))
    if (link.other == b) link.edges |= ClusterLink::kRefused;
  for (ClusterLink& link : graph_.links_of(b))
    if (link.other == a) link.edges |= ClusterLink::kRefused;
  choices_[a].other = choices_[b].other = kUnknown;
}

// Rounding may leave a ring of choices without a pair; then the cheapest one merges. False where
// nothing can be chosen.
bool MergeRounds::pair_cheapest(const MergeLimits& limits) {
  std::uint32_t best = kNone;
  for (const std::uint32_t c : alive_)
    if (choices_[c].other != kNone && (best == kNone || choices_[c].cost < choices_[best].cost))
      best = c;
  if (best == kNone) return false;
  const std::uint32_t other = choices_[best].other;
  if (is_allowed(best, other, limits.discs))
    pairs_.push_back({std::min(best, other), std::max(best, other), choices_[best].cost, 0, 0});
  else
    refuse(best, other);
  return true;
}

void MergeRounds::keep_cheapest(std::uint32_t wanted) {
  if (pairs_.size() <= wanted) return;
  std::nth_element(
      pairs_.begin(), pairs_.begin() + wanted, pairs_.end(),
      [](const Pair& x, const Pair& y) { return x.cost != y.cost ? x.cost < y.cost : x.a < y.a; });
  pairs_.resize(wanted);
}

void MergeRounds::merge_pairs() {
  reserve_rows();
  parallel_for(threads_, pairs_.size(), kGrain / 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) merge(pairs_[i]);
  });
  alive_.erase(
      std::remove_if(alive_.begin(), alive_.end(), [&](std::uint32_t c) { return into_[c] != c; }),
      alive_.end());
}

// Finds places for the rows of the unions.
void MergeRounds::reserve_rows() {
  std::size_t links = 0, points = 0;
  for (const Pair& pair : pairs_) {
    links += graph_.link_rows[pair.a].count + graph_.link_rows[pair.b].count;
    points += graph_.point_rows[pair.a].count + graph_.point_rows[pair.b].count;
  }
  if (used_links_ + links > graph_.links.size() || used_points_ + points > graph_.points.size())
    compact();
  for (Pair& pair : pairs_) {
    pair.links = used_links_;
    pair.points = used_points_;
    used_links_ += graph_.link_rows[pair.a].count + graph_.link_rows[pair.b].count;
    used_points_ += graph_.point_rows[pair.a].count + graph_.point_rows[pair.b].count;
  }
}

// Copies the rows that are in use to new arrays, with as much room again behind them.
void MergeRounds::compact() {
  std::size_t links = 0, points = 0;
  for (const std::uint32_t c : alive_) {
    links += graph_.link_rows[c].count;
    points += graph_.point_rows[c].count;
  }
  const auto copy = [&](auto& rows, auto& items, std::size_t count, std::uint32_t& used) {
    std::remove_reference_t<decltype(items)> packed(2 * count);
    used = 0;
    for (const std::uint32_t c : alive_) {
      std::copy_n(items.begin() + rows[c].begin, rows[c].count, packed.begin() + used);
      rows[c].begin = used;
      used += rows[c].count;
    }
    items = std::move(packed);
  };
  copy(graph_.link_rows, graph_.links, links, used_links_);
  copy(graph_.point_rows, graph_.points, points, used_points_);
}

void MergeRounds::merge(const Pair& pair) {
  const auto [a, b] = std::pair(pair.a, pair.b);
  const ClusterLink link = find_link(graph_, a, b);
  const std::uint32_t points = merge_points(pair);
  merge_links(pair);
  ClusterShape& shape = graph_.shapes[a];
  const ClusterShape& other = graph_.shapes[b];
  shape.area += other.area;
  shape.outline += other.outline - 2 * std::max(link.length, 0.0f);
  shape.outline = std::max(shape.outline, 0.0f);
  shape.triangles += other.triangles;
  shape.euler += other.euler - static_cast<std::int32_t>(points - link.edge_count());
  into_[b] = a;
  choices_[a].changed_at = round_;
  choices_[a].other = kUnknown;
}

// Puts the links of both parts in one row; refresh_links() finds the equal ones.
void MergeRounds::merge_links(const Pair& pair) {
  std::uint32_t count = 0;
  for (const std::uint32_t part : {pair.a, pair.b})
    for (ClusterLink link : std::as_const(graph_).links_of(part)) {
      if (link.other == pair.a || link.other == pair.b) continue;
      link.edges &= ~ClusterLink::kRefused;
      graph_.links[pair.links + count++] = link;
    }
  graph_.link_rows[pair.a] = {pair.links, count};
}

// Whether another cluster has a point, after two that had it have merged.
bool MergeRounds::is_shared(std::uint32_t point, bool was_common) {
  // What no other cluster has is common to none: whether it is dropped now or, where another thread
  // is about to lower its count, later, makes no difference to any result.
  if (graph_.clusters_at.empty()) return true;
  const std::atomic_ref<std::uint32_t> clusters(graph_.clusters_at[point]);
  if (was_common) clusters.fetch_sub(1, std::memory_order_relaxed);
  return clusters.load(std::memory_order_relaxed) > 1;
}

// Returns how many points the two have in common.
std::uint32_t MergeRounds::merge_points(const Pair& pair) {
  std::uint32_t* points = graph_.points.data() + pair.points;
  std::uint32_t count = 0, common = 0;
  const std::span<const std::uint32_t> p = graph_.points_of(pair.a), q = graph_.points_of(pair.b);
  for (std::size_t i = 0, j = 0; i < p.size() || j < q.size();) {
    const std::uint32_t x = i < p.size() ? p[i] : kNone, y = j < q.size() ? q[j] : kNone;
    const std::uint32_t point = std::min(x, y);
    common += x == y;
    i += x <= y;
    j += y <= x;
    points[count] = point;
    count += is_shared(point, x == y);
  }
  graph_.point_rows[pair.a] = {pair.points, count};
  return common;
}

}  // namespace varifold
