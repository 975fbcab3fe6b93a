// Based on: [BeesonDemer2002] (several strips are tried from each of several seeds beside what is
//   done, the one that suits the cache best is kept, and the next ones begin near it).
// Differs: candidates are judged by a simulation of the whole cache; their length is bounded by
//   the size of the cache, so that the next row still finds the vertices of the last one.
#include <varifold/strip/cache_strips.h>
#include <algorithm>
#include <utility>

namespace varifold {

namespace {

constexpr float kIndexCost = 0.25f;  // of an index that makes no triangle, in misses
constexpr std::size_t kSeeds = 8;
constexpr std::size_t kRecent = 16;

}  // namespace

CacheStrips::CacheStrips(std::span<const std::uint32_t> indices, std::uint32_t vertex_count,
                         std::uint32_t cache_size, StripPaths& paths,
                         std::vector<std::uint8_t> taken)
    : indices_(indices),
      paths_(paths),
      cache_size_(cache_size),
      // Two rows beside each other share their vertices as long as the cache holds one of them.
      max_length_(std::max(4u, cache_size * 5 / 8)),
      free_(paths, std::move(taken)),
      cache_(vertex_count, cache_size),
      trial_(vertex_count, 0),
      trial_miss_(vertex_count, 0),
      in_trial_(paths.triangle_count(), 0) {}

std::vector<std::uint32_t> CacheStrips::run() {
  while (true) {
    gather_seeds();
    if (seeds_.empty()) {
      const std::uint32_t seed = free_.fewest_neighbors();
      if (seed == kNone) break;
      seeds_.push_back(seed);
    }
    Candidate best;
    for (const std::uint32_t seed : seeds_) try_from(seed, best);
    commit(best);
  }
  return std::move(order_);
}

std::uint32_t CacheStrips::cached_corners(std::uint32_t triangle) const {
  std::uint32_t count = 0;
  for (std::uint32_t c = 0; c < 3; ++c) count += cache_.holds(indices_[3 * triangle + c]) ? 1 : 0;
  return count;
}

// Free triangles beside the last strips: those with most corners in the cache, then with the
// fewest free neighbours.
void CacheStrips::gather_seeds() {
  seeds_.clear();
  for (std::size_t i = recent_.size(); i-- > 0;) {
    for (std::uint32_t h = 3 * recent_[i]; h < 3 * recent_[i] + 3; ++h)
      if (free_.is_free(h)) seeds_.push_back(paths_.across(h) / 3);
  }
  const auto rank = [&](std::uint32_t t) {
    return 4 * (3 - cached_corners(t)) + free_.neighbors(t);
  };
  std::stable_sort(seeds_.begin(), seeds_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return rank(a) < rank(b); });
  if (seeds_.size() > kSeeds) seeds_.resize(kSeeds);
}

void CacheStrips::try_from(std::uint32_t triangle, Candidate& best) {
  for (std::uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
    for (const std::uint32_t first_turn : {1u, 0u}) {
      const Candidate candidate = simulate(h, first_turn);
      if (best.exit == kNone || candidate.cost < best.cost) best = candidate;
      if (candidate.length < 3) break;  // no turn
    }
  }
}

// Misses after using a vertex, where there were `misses` in this simulation before.
std::uint32_t CacheStrips::trial_use(std::uint32_t vertex, std::uint32_t misses) {
  const bool here = trial_[vertex] == trial_count_ && misses - trial_miss_[vertex] < cache_size_;
  if (here || cache_.would_hold(vertex, misses)) return misses;
  trial_[vertex] = trial_count_;
  trial_miss_[vertex] = misses + 1;
  return misses + 1;
}

// Whether a strip could go on from the end of the last one, and the swaps that takes.
CacheStrips::Joint CacheStrips::joint_before(std::uint32_t exit, std::uint32_t first_turn,
                                             std::uint32_t length) const {
  Joint best;
  for (const std::uint32_t entry : {next_half_edge(exit), previous_half_edge(exit), exit}) {
    if (entry == exit && length > 1) break;
    const std::uint32_t out = paths_.across(entry);
    if (out == kNone || out / 3 != tail_.triangle) continue;
    const std::uint32_t at_tail = tail_.entry == kNone ? kNoTurn : turn(tail_.entry, out);
    const std::uint32_t here = length > 1 ? turn(entry, exit) : kNoTurn;
    const std::uint32_t then = length > 2 ? first_turn : kNoTurn;
    const int swaps =
        swap_cost(tail_.last_turn, at_tail) + swap_cost(at_tail, here) + swap_cost(here, then);
    if (best.entry == kNone || swaps < best.swaps) best = {entry, swaps};
  }
  return best;
}

CacheStrips::Candidate CacheStrips::simulate(std::uint32_t exit, std::uint32_t first_turn) {
  ++trial_count_;
  Candidate best{exit, first_turn};
  std::uint32_t misses = 0;
  for (std::uint32_t c = 0; c < 3; ++c) misses = trial_use(indices_[exit - exit % 3 + c], misses);
  in_trial_[exit / 3] = trial_count_;
  std::uint32_t h = exit, next_turn = first_turn;
  for (std::uint32_t length = 1;; ++length) {
    const Joint joint = joint_before(exit, first_turn, length);
    const int alone = kStripCost + (length > 2 && first_turn == 0 ? 1 : 0);
    const bool joined = joint.entry != kNone && joint.swaps < alone;
    const float extra = kIndexCost * static_cast<float>(joined ? joint.swaps : alone);
    const float cost = (static_cast<float>(misses) + extra) / static_cast<float>(length);
    if (best.length == 0 || cost <= best.cost) {
      best.length = length;
      best.cost = cost;
      best.joint = joined ? joint.entry : kNone;
    }
    if (length == max_length_ || !free_.is_free(h)) return best;
    const std::uint32_t entry = paths_.across(h);
    if (in_trial_[entry / 3] == trial_count_) return best;
    in_trial_[entry / 3] = trial_count_;
    misses = trial_use(indices_[previous_half_edge(entry)], misses);
    h = exit_of(entry, next_turn);
    next_turn ^= 1u;
  }
}

void CacheStrips::take(std::uint32_t triangle) {
  free_.take(triangle);
  recent_.push_back(triangle);
}

void CacheStrips::commit(const Candidate& candidate) {
  std::uint32_t exit = candidate.exit, next_turn = candidate.first_turn;
  if (candidate.joint == kNone) {
    order_.push_back(exit);
    tail_ = {exit / 3, kNone, kNoTurn};
  } else {
    const std::uint32_t out = paths_.across(candidate.joint);
    paths_.link(out);
    const std::uint32_t at_tail = tail_.entry == kNone ? kNoTurn : turn(tail_.entry, out);
    tail_ = {exit / 3, candidate.joint, at_tail};
  }
  for (const std::uint32_t corner : {previous_half_edge(exit), exit, next_half_edge(exit)})
    cache_.use(indices_[corner]);
  take(exit / 3);
  for (std::uint32_t i = 1; i < candidate.length; ++i) {
    const std::uint32_t entry = paths_.across(exit);
    paths_.link(exit);
    const std::uint32_t last_turn = tail_.entry == kNone ? kNoTurn : turn(tail_.entry, exit);
    tail_ = {entry / 3, entry, last_turn};
    cache_.use(indices_[previous_half_edge(entry)]);
    take(entry / 3);
    exit = exit_of(entry, next_turn);
    next_turn ^= 1u;
  }
  if (recent_.size() > 2 * kRecent)
    recent_.erase(recent_.begin(), recent_.end() - static_cast<std::ptrdiff_t>(kRecent));
}

}  // namespace varifold
