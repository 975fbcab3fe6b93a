// The part of BorderGuard that finds regions which would show the same edge.
#include <varifold/models/patch_tree/border_guard.h>

#include <algorithm>
#include <utility>

namespace varifold {

namespace {

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

}  // namespace

// An edge of K between two points of borders, as it may be drawn: inside a region, or on a border.
void BorderGuard::find_chords(std::uint32_t border, bool all, std::vector<Chord>& chords) const {
  const BorderPoint& p = points_[border];
  for (const StarFace& out : star(p)) {
    const std::uint32_t other = border_of_[out.from];
    if (other == kNone) continue;
    std::uint32_t beyond = kNone;
    for (const StarFace& in : star(p))
      if (in.to == out.from) beyond = in.region;
    if (!all && beyond == out.region && out.from < p.point) continue;  // seen from the other end
    const std::uint32_t ends[2] = {border, other};
    for (std::uint32_t moved = 0; moved < 4; ++moved) {
      Chord chord{0, {{out.region, false}, {}, {}}, beyond, border, other};
      std::uint32_t shown[2];
      bool possible = true;
      for (std::uint32_t k = 0; k < 2; ++k) {
        const BorderPoint& end = points_[ends[k]];
        const bool moves = (moved >> k & 1) != 0;
        shown[k] = moves ? points_[end.target].point : end.point;
        if (end.target != ends[k])
          chord.needs[1 + k] = {end.other_than(out.region), moves};
        else
          possible &= !moves;
      }
      if (!possible || shown[0] == shown[1]) continue;
      chord.edge = key_of(shown[0], shown[1]);
      chords.push_back(chord);
    }
  }
}

void BorderGuard::find_new_chords(std::uint32_t border, std::vector<Chord>& chords) const {
  const std::uint32_t point = points_[border].point;
  const auto ring = surface_.ring_span(point);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const RingEntry& before = ring[i == 0 ? ring.size() - 1 : i - 1];
    const std::uint32_t neighbor = ring[i].neighbor;
    if (neighbor < point || border_of_[neighbor] == kNone) continue;
    if (ring[i].face == kNone || before.face == kNone) continue;
    const std::uint32_t region = surface_.region_of[ring[i].face];
    if (region != surface_.region_of[before.face]) continue;
    chords.push_back({std::uint64_t{point} << 32 | neighbor,
                      {{region, true}, {}, {}},
                      region,
                      border,
                      border_of_[neighbor]});
  }
}

// Whether K had the edge in that region: then all that show it show one edge of K.
bool BorderGuard::was_edge(const Chord& chord) const {
  const std::uint32_t other = points_[chord.b].point;
  const auto faces = star(points_[chord.a]);
  return std::any_of(faces.begin(), faces.end(), [&](const StarFace& face) {
    return face.region == chord.needs[0].region && (face.from == other || face.to == other);
  });
}

// Whether two regions may show the same edge at one time, not as their common border.
bool BorderGuard::clash(const Chord& x, const Chord& y) const {
  if (x.needs[0].region == y.needs[0].region) return false;  // fans tell
  if (x.is_border() && y.is_border()) return false;
  if (x.is_border() && x.beyond == y.needs[0].region) return false;
  if (y.is_border() && y.beyond == x.needs[0].region) return false;
  if (std::minmax(x.a, x.b) == std::minmax(y.a, y.b) && was_edge(x) && was_edge(y)) return false;
  for (const Need& a : x.needs)
    for (const Need& b : y.needs)
      if (a.region != kNone && a.region == b.region && a.coarse != b.coarse) return false;
  return true;
}

// Nearly all clashes are between two regions at a corner onto which points of both have moved.
bool BorderGuard::is_free_of_clashes(std::uint32_t corner) const {
  thread_local std::vector<Chord> chords;  // so that its memory is kept
  chords.clear();
  for (std::uint32_t i = corner; i != kNone; i = points_[i].next) find_chords(i, true, chords);
  std::sort(chords.begin(), chords.end());
  for (std::size_t i = 0; i < chords.size(); ++i)
    for (std::size_t j = i; j-- > 0 && chords[j].edge == chords[i].edge;)
      if (clash(chords[i], chords[j])) return false;
  return true;
}

bool BorderGuard::lock_chords(std::vector<Chord>& chords, BorderLocks& locks) const {
  bool any = false;
  std::sort(chords.begin(), chords.end());
  const auto lock = [&](const Chord& chord) {
    if (chord.needs[0].coarse)
      locks.edges.emplace_back(static_cast<std::uint32_t>(chord.edge >> 32),
                               static_cast<std::uint32_t>(chord.edge));
    for (const std::uint32_t b : {chord.a, chord.b})
      if (points_[b].target != b) locks.points.push_back(points_[b].point);
  };
  for (std::size_t first = 0, last; first < chords.size(); first = last) {
    last = first + 1;
    while (last < chords.size() && chords[last].edge == chords[first].edge) ++last;
    for (std::size_t i = first; i < last; ++i)
      for (std::size_t j = first; j < i; ++j)
        if (clash(chords[i], chords[j])) {
          any = true;
          lock(chords[i]);
          lock(chords[j]);
        }
  }
  return any;
}

}  // namespace varifold
