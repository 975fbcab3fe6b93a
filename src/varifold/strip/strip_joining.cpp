// Based on: [Stewart2001] (tunnels between the ends of strips).
// Differs: tunnels cross at most one strip, and count swaps as well as strips.
#include <varifold/strip/strip_joining.h>
#include <algorithm>
#include <array>
#include <utility>

namespace varifold {

namespace {

constexpr int kMostGain = kStripCost + 1;  // a strip, and a swap at a beginning

// Triangles from a tunnel to the ends of the strip that it crosses; more gains 1 % of indices.
constexpr std::uint32_t kMaxWalk = 40;

class PathJoiner {
 public:
  PathJoiner(StripPaths& paths, const std::vector<std::uint8_t>& in_strip)
      : paths_(paths), in_strip_(in_strip), far_end_(paths.triangle_count(), kNone) {
    for (std::uint32_t t = 0; t < paths_.triangle_count(); ++t)
      if (is_end(t) && far_end_[t] == kNone) set_ends(t, walk_to_end(t));
  }

  void run() {
    join_touching();
    for (std::uint32_t t = 0; t < paths_.triangle_count(); ++t)
      if (is_end(t)) tunnel_from(t);
    join_touching();
  }

 private:
  [[nodiscard]] bool is_end(std::uint32_t t) const { return in_strip_[t] && paths_.degree(t) < 2; }
  void set_ends(std::uint32_t a, std::uint32_t b) {
    far_end_[a] = b;
    far_end_[b] = a;
  }
  // The end of the strip of an end triangle `t`, on its other side.
  [[nodiscard]] std::uint32_t walk_to_end(std::uint32_t t) const {
    if (paths_.degree(t) == 0) return t;
    std::uint32_t exit = paths_.some_link(t);
    while (exit != kNone) {
      t = paths_.across(exit) / 3;
      exit = paths_.other_link(paths_.across(exit));
    }
    return t;
  }

  // The turn of a strip in the triangle after the one that `exit` leaves.
  [[nodiscard]] std::uint32_t turn_behind(std::uint32_t exit) const {
    const std::uint32_t entry = paths_.across(exit);
    const std::uint32_t out = paths_.other_link(entry);
    return out == kNone ? kNoTurn : turn(entry, out);
  }
  // 1 where a strip cannot begin at either end without a swap: its first turn has to be of kind 1.
  [[nodiscard]] int start_cost(std::uint32_t a, std::uint32_t b) const {
    if (paths_.degree(a) == 0 || paths_.degree(b) == 0) return 0;
    const std::uint32_t at_a = turn_behind(paths_.some_link(a));
    if (at_a == kNoTurn || at_a == 1) return 0;
    return turn_behind(paths_.some_link(b)) == 1 ? 0 : 1;
  }
  // Swaps at and next to the triangles on both sides of a linked half-edge.
  [[nodiscard]] int swaps_near(std::uint32_t half_edge) const {
    const std::uint32_t other = paths_.across(half_edge);
    const std::uint32_t before = paths_.other_link(half_edge), after = paths_.other_link(other);
    // All turns as seen when walking through half_edge.
    const std::uint32_t t1 = before == kNone ? kNoTurn : turn(before, half_edge);
    const std::uint32_t t2 = after == kNone ? kNoTurn : turn(other, after);
    const std::uint32_t t0 = before == kNone ? kNoTurn : reversed(turn_behind(before));
    const std::uint32_t t3 = after == kNone ? kNoTurn : turn_behind(after);
    return swap_cost(t0, t1) + swap_cost(t1, t2) + swap_cost(t2, t3);
  }
  static std::uint32_t reversed(std::uint32_t turn) { return turn == kNoTurn ? turn : turn ^ 1u; }

  // What linking two ends would save, in indices.
  [[nodiscard]] int gain(std::uint32_t half_edge) {
    const std::uint32_t a = half_edge / 3, b = paths_.across(half_edge) / 3;
    const std::uint32_t far_a = far_end_[a], far_b = far_end_[b];
    const int before = start_cost(a, far_a) + start_cost(b, far_b);
    paths_.link(half_edge);
    const int after = start_cost(far_a, far_b) + swaps_near(half_edge);
    paths_.unlink(half_edge);
    return kStripCost + before - after;
  }
  // Whether linking across a half-edge would join two different strips at their ends.
  [[nodiscard]] bool can_join(std::uint32_t half_edge) const {
    const std::uint32_t other = paths_.across(half_edge);
    return other != kNone && is_end(half_edge / 3) && is_end(other / 3) &&
           !paths_.linked(half_edge) && far_end_[half_edge / 3] != other / 3 &&
           half_edge / 3 != other / 3;
  }
  void join(std::uint32_t half_edge) {
    const std::uint32_t far_a = far_end_[half_edge / 3];
    const std::uint32_t far_b = far_end_[paths_.across(half_edge) / 3];
    paths_.link(half_edge);
    set_ends(far_a, far_b);
  }
  // The best gains first; one that others have made smaller waits for its turn.
  void join_touching() {
    std::array<std::vector<std::uint32_t>, kMostGain + 1> waiting;  // half-edges by gain
    const auto wait = [&](std::uint32_t h, int most) {
      const int saved = std::min(gain(h), most);
      if (saved > 0) waiting[static_cast<std::size_t>(saved)].push_back(h);
    };
    for (std::uint32_t h = 0; h < 3 * paths_.triangle_count(); ++h)
      if (is_end(h / 3) && can_join(h) && h < paths_.across(h)) wait(h, kMostGain);
    for (int most = kMostGain; most > 0; --most) {
      for (const std::uint32_t h : waiting[static_cast<std::size_t>(most)]) {
        if (!can_join(h)) continue;
        if (gain(h) >= most)
          join(h);
        else
          wait(h, most - 1);
      }
    }
  }

  // From end triangle `t` into a strip beside it.
  void tunnel_from(std::uint32_t t) {
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      const std::uint32_t other = paths_.across(h);
      if (other == kNone || paths_.linked(h)) continue;
      if (can_join(h) && gain(h) > 0) return join(h);
      if (paths_.degree(other / 3) != 2) continue;
      if (tunnel_through(h, next_half_edge(other)) || tunnel_through(h, previous_half_edge(other)))
        return;
    }
  }

  // Links the end at half-edge `h`, cuts the strip beyond at `cut`, and joins what is cut off to
  // an end that it touches, if any. Undone where nothing is saved.
  bool tunnel_through(std::uint32_t h, std::uint32_t cut) {
    const std::uint32_t t = h / 3, off = paths_.across(cut) / 3;
    if (!paths_.linked(cut)) return false;
    int saved = swaps_near(cut);
    paths_.unlink(cut);
    paths_.link(h);
    saved -= swaps_near(h);
    paths_.unlink(h);
    paths_.link(cut);
    if (saved <= 0 && !touches_end(off, t)) return false;  // ends are far to walk
    std::uint32_t kept_end = 0, off_end = 0;
    if (!find_end(cut, kept_end) || !find_end(paths_.across(cut), off_end)) return false;
    if (kept_end == t || off_end == t) return false;  // into itself
    const std::uint32_t far = far_end_[t];
    saved += start_cost(t, far) + start_cost(kept_end, off_end);
    paths_.unlink(cut);
    paths_.link(h);
    set_ends(far, kept_end);
    set_ends(off, off_end);
    saved -= start_cost(far, kept_end) + start_cost(off, off_end);
    const auto [joint, joint_gain] = best_joint(off);
    if (saved + joint_gain <= 0) {
      paths_.unlink(h);
      paths_.link(cut);
      set_ends(t, far);
      set_ends(kept_end, off_end);
      return false;
    }
    if (joint != kNone) join(joint);
    return true;
  }
  [[nodiscard]] bool touches_end(std::uint32_t t, std::uint32_t but) const {
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      const std::uint32_t other = paths_.across(h);
      if (other != kNone && other / 3 != but && is_end(other / 3) && !paths_.linked(h)) return true;
    }
    return false;
  }
  // The half-edge of an end triangle across which joining gains the most; kNone, 0 where none.
  [[nodiscard]] std::pair<std::uint32_t, int> best_joint(std::uint32_t t) {
    std::pair<std::uint32_t, int> best{kNone, 0};
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h)
      if (can_join(h) && gain(h) > best.second) best = {h, gain(h)};
    return best;
  }

  // The end of a strip on this side of a linked half-edge; false where it is too far.
  [[nodiscard]] bool find_end(std::uint32_t half_edge, std::uint32_t& end) const {
    std::uint32_t entry = half_edge;
    for (std::uint32_t i = 0; i < kMaxWalk; ++i) {
      end = entry / 3;
      const std::uint32_t exit = paths_.other_link(entry);
      if (exit == kNone) return true;
      entry = paths_.across(exit);
    }
    return false;
  }

  StripPaths& paths_;
  const std::vector<std::uint8_t>& in_strip_;
  std::vector<std::uint32_t> far_end_;  // of ends; for others meaningless
};

}  // namespace

void join_paths(StripPaths& paths, const std::vector<std::uint8_t>& in_strip) {
  PathJoiner(paths, in_strip).run();
}

}  // namespace varifold
