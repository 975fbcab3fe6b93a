// Based on: [EvansSkienaVarshney1996] section 4 (local algorithms and their tie-breaking rules);
//   the start from, and the way to, the triangle with the fewest neighbours come from the program
//   tomesh [AkeleyHaeberliBurns1990].
// Differs: strips grow at both ends. kStraight prefers a step without a swap to the fewest
//   neighbours, and starts in the direction that goes farthest.
#include <varifold/strip/strip_growth.h>
#include <algorithm>
#include <utility>

namespace varifold {

namespace {

constexpr std::uint32_t kMaxTrial = 64;

}  // namespace

StripGrowth::StripGrowth(StripPaths& paths, std::vector<std::uint8_t> taken,
                         const StripifyOptions& options)
    : paths_(paths),
      heuristic_(options.heuristic),
      random_(options.seed),
      free_(paths, std::move(taken)),
      trial_(paths.triangle_count(), 0) {}

void StripGrowth::run() {
  for (std::uint32_t t = free_.fewest_neighbors(); t != kNone; t = free_.fewest_neighbors())
    grow(t);
}

void StripGrowth::grow(std::uint32_t start) {
  free_.take(start);
  const std::uint32_t exit = first_exit(start);
  if (exit == kNone) return;
  extend(exit, kNoTurn);
  // The other way, as a continuation of the strip just made.
  const std::uint32_t entry = exit;
  const std::uint32_t second = paths_.across(exit), beyond = paths_.other_link(second);
  const std::uint32_t last_turn = beyond == kNone ? kNoTurn : turn(beyond, second);
  const std::uint32_t back = choose(entry, last_turn);
  if (back != kNone) extend(back, turn(entry, back));
}

// Goes on through `exit`, after a turn of that kind.
void StripGrowth::extend(std::uint32_t exit, std::uint32_t last_turn) {
  while (exit != kNone) {
    const std::uint32_t entry = paths_.across(exit);
    paths_.link(exit);
    free_.take(entry / 3);
    exit = choose(entry, last_turn);
    if (exit != kNone) last_turn = turn(entry, exit);
  }
}

std::uint32_t StripGrowth::first_exit(std::uint32_t start) {
  std::uint32_t best = kNone, best_cost = 0;
  for (std::uint32_t h = 3 * start; h < 3 * start + 3; ++h) {
    if (!free_.is_free(h)) continue;
    const std::uint32_t cost =
        heuristic_ >= StripHeuristic::kStraight ? kMaxTrial - straight_length(h) : free_behind(h);
    if (best != kNone && cost >= best_cost) continue;
    best = h;
    best_cost = cost;
  }
  return best;
}

// How far a strip without swaps gets through `exit`, at most kMaxTrial triangles; the better of
// both kinds of first turn.
std::uint32_t StripGrowth::straight_length(std::uint32_t exit) {
  std::uint32_t longest = 0;
  for (std::uint32_t first_turn = 0; first_turn < 2; ++first_turn) {
    ++trial_count_;
    std::uint32_t length = 0, next_turn = first_turn;
    for (std::uint32_t h = exit; length < kMaxTrial && free_.is_free(h); next_turn ^= 1u) {
      const std::uint32_t entry = paths_.across(h);
      if (trial_[entry / 3] == trial_count_) break;
      trial_[entry / 3] = trial_count_;
      ++length;
      h = exit_of(entry, next_turn);
    }
    longest = std::max(longest, length);
  }
  return longest;
}

// The way out of a triangle that was entered by `entry`, or kNone.
std::uint32_t StripGrowth::choose(std::uint32_t entry, std::uint32_t last_turn) {
  const std::uint32_t a = exit_of(entry, 0), b = exit_of(entry, 1);
  if (!free_.is_free(a) || !free_.is_free(b))
    return free_.is_free(a) ? a : free_.is_free(b) ? b : kNone;
  if (heuristic_ >= StripHeuristic::kStraight) {
    if (last_turn != kNoTurn) return last_turn == 1 ? a : b;
    return straight_length(a) >= straight_length(b) ? a : b;
  }
  if (free_behind(a) != free_behind(b)) return free_behind(a) < free_behind(b) ? a : b;
  return break_tie(entry, last_turn);
}

std::uint32_t StripGrowth::break_tie(std::uint32_t entry, std::uint32_t last_turn) {
  const std::uint32_t a = exit_of(entry, 0), b = exit_of(entry, 1);
  switch (heuristic_) {
    case StripHeuristic::kRandom:
      return random_.below(2) == 0 ? a : b;
    case StripHeuristic::kLookAhead:
      return least_behind(a) <= least_behind(b) ? a : b;
    case StripHeuristic::kAlternate:
      left_next_ = !left_next_;
      return left_next_ ? a : b;
    case StripHeuristic::kSequential:
      return last_turn == 0 ? b : a;
    default:
      return a;
  }
}

// The fewest free neighbours that a free neighbour of the triangle across has.
std::uint32_t StripGrowth::least_behind(std::uint32_t half_edge) const {
  const std::uint32_t entry = paths_.across(half_edge);
  std::uint32_t least = 4;
  for (std::uint32_t side = 0; side < 2; ++side) {
    const std::uint32_t exit = exit_of(entry, side);
    if (free_.is_free(exit)) least = std::min(least, free_behind(exit));
  }
  return least;
}

}  // namespace varifold
