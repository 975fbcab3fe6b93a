#include <varifold/partition/path_mover.h>

#include <varifold/partition/vertex_fans.h>
#include <algorithm>

namespace varifold {

bool PathMover::shorten(std::uint32_t stretch) {
  bool is_shorter = false;
  for (bool again = true; again;) {
    again = false;
    if (!corridor_.find_shorter(patched_, stretch)) {
      is_blocked_ = corridor_.is_blocked();
    } else if (!is_sound_path()) {
      again = true;  // its points are fixed now, and there may be another
    } else {
      is_shorter = move(stretch);
      is_blocked_ = true;  // whether it is will be seen when a patch has changed
    }
    corridor_.clear(patched_);
  }
  return is_shorter;
}

bool PathMover::move(std::uint32_t number) {
  Stretch& stretch = patched_.borders.stretches[number];
  const std::vector<std::uint32_t>& path = corridor_.path();
  changed_.clear();
  if (!flip_between(stretch) || !is_border(stretch) || !count_sizes(stretch)) {
    for (const std::uint32_t t : changed_) flip(stretch, t);
    return false;
  }
  for (std::size_t i = 1; i + 1 < stretch.path.size(); ++i)
    patched_.borders.use_of[stretch.path[i]] = PointUse::kInside;
  for (std::size_t i = 1; i + 1 < path.size(); ++i) patched_.borders.use_of[path[i]] = number;
  stretch.path = path;
  stretch.end_spokes = corridor_.end_spokes();
  return true;
}

// Points where fans touch cannot be in a path.
bool PathMover::is_sound(std::uint32_t point) {
  std::uint32_t& use = patched_.borders.use_of[point];
  if (use != PointUse::kInside) return true;
  if (is_closed_fan(patched_.surface, patched_.links, patched_.borders.spokes[point],
                    patched_.borders.triangles_at[point]))
    return true;
  use = PointUse::kFixed;
  return false;
}

bool PathMover::is_sound_path() {
  bool all = true;
  for (std::size_t i = 1; i + 1 < corridor_.path().size(); ++i)
    all &= is_sound(corridor_.path()[i]);
  return all;
}

void PathMover::flip(const Stretch& stretch, std::uint32_t triangle) {
  patched_.set_patch(triangle, patched_.patch(triangle) == stretch.a ? stretch.b : stretch.a);
}

// Counts the triangles of both patches anew. False where one would grow beyond the limit.
bool PathMover::count_sizes(const Stretch& stretch) {
  std::uint32_t to_a = 0;
  for (const std::uint32_t t : changed_) to_a += patched_.patch(t) == stretch.a;
  const auto to_b = static_cast<std::uint32_t>(changed_.size()) - to_a;
  std::uint32_t& a = sizes_[stretch.a];
  std::uint32_t& b = sizes_[stretch.b];
  if ((to_a > to_b && a + to_a - to_b > max_triangles_) ||
      (to_b > to_a && b + to_b - to_a > max_triangles_))
    return false;
  a += to_a - to_b;
  b += to_b - to_a;
  return true;
}

// Hands over the triangles between the old and the new path, piece by piece.
bool PathMover::flip_between(const Stretch& stretch) {
  const std::vector<std::uint32_t>& path = corridor_.path();
  for (std::uint32_t begin = 0; begin + 1 < path.size();) {
    std::uint32_t end = begin + 1;
    while (places(path[end]).in_old == kNone) ++end;
    const std::uint32_t from = places(path[begin]).in_old, to = places(path[end]).in_old;
    if (to <= from) return false;
    const bool is_same_edge = end == begin + 1 && to == from + 1;
    if (!is_same_edge && !flip_piece(stretch, begin, from, to)) return false;
    begin = end;
  }
  return true;
}

// The piece is bounded by the old path from `from` to `to` and the new one from `begin` on.
bool PathMover::flip_piece(const Stretch& stretch, std::uint32_t begin, std::uint32_t from,
                           std::uint32_t to) {
  const std::uint32_t side = side_of(begin);
  if (side != stretch.a && side != stretch.b) return false;
  const std::size_t first = changed_.size();
  for (std::uint32_t i = from; i < to; ++i) {
    const std::uint32_t t = triangle_at(stretch.path[i], stretch.path[i + 1], side);
    if (t != kNone) take(stretch, t, side);
  }
  for (std::size_t i = first; i < changed_.size(); ++i) {
    const std::uint32_t t = changed_[i];
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      if (is_step_of(h, &Places::in_old) || is_step_of(h, &Places::in_new)) continue;
      if (!is_between(stretch, h)) return false;
      take(stretch, patched_.links.across_in_material(h) / 3, side);
    }
  }
  return true;
}

// Whether an edge of neither path can be between the two: it leads to one of the patches, and its
// ends are not on another border. Else the paths run around a handle or a hole.
bool PathMover::is_between(const Stretch& stretch, std::uint32_t h) const {
  const std::uint32_t g = patched_.links.across_in_material(h);
  if (g == kNone) return false;
  const std::uint32_t patch = patched_.patch(g / 3);
  if (patch != stretch.a && patch != stretch.b) return false;
  std::uint32_t corners = 0;
  for (const std::uint32_t end : {h, next_in_triangle(h)}) {
    const std::uint32_t point = patched_.surface.corners[end];
    if (point == stretch.path.front() || point == stretch.path.back())
      ++corners;
    else if (patched_.borders.use_of[point] != PointUse::kInside && places(point).in_old == kNone)
      return false;
  }
  return corners < 2;
}

void PathMover::take(const Stretch& stretch, std::uint32_t triangle, std::uint32_t side) {
  if (patched_.patch(triangle) != side) return;
  changed_.push_back(triangle);
  patched_.set_patch(triangle, side == stretch.a ? stretch.b : stretch.a);
}

// Visits the two triangles of an edge between points of the corridor.
template <class Visit>
void PathMover::for_each_side(std::uint32_t p, std::uint32_t q, const Visit& visit) const {
  const std::uint32_t h = find_edge(p, q);
  if (h == kNone) return;
  visit(h / 3);
  if (const std::uint32_t g = patched_.links.across_in_material(h); g != kNone) visit(g / 3);
}
// The patch that the edge of the new path after `begin` runs through.
std::uint32_t PathMover::side_of(std::uint32_t begin) const {
  const std::vector<std::uint32_t>& path = corridor_.path();
  std::uint32_t side = kNone;
  for_each_side(path[begin], path[begin + 1], [&](std::uint32_t t) {
    const std::uint32_t patch = patched_.patch(t);
    side = side == kNone || side == patch ? patch : kNone - 1;
  });
  return side;
}

std::uint32_t PathMover::triangle_at(std::uint32_t p, std::uint32_t q, std::uint32_t patch) const {
  std::uint32_t found = kNone;
  for_each_side(p, q, [&](std::uint32_t t) {
    if (patched_.patch(t) == patch) found = t;
  });
  return found;
}

std::uint32_t PathMover::find_edge(std::uint32_t p, std::uint32_t q) const {
  const std::uint32_t spoke = corridor_.spoke(patched_, p);
  for (const std::uint32_t first : {spoke, other_spoke(patched_.surface, spoke, p)})
    for (std::uint32_t h = first;;) {
      if (other_end(patched_.surface, h, p) == q) return h;
      const std::uint32_t g = patched_.links.across_in_material(h);
      if (g == kNone || g / 3 == spoke / 3) break;
      h = other_spoke(patched_.surface, g, p);
    }
  return kNone;
}

// Whether a half-edge joins two points that follow each other in a path.
bool PathMover::is_step_of(std::uint32_t h, std::uint32_t Places::*path) const {
  const std::uint32_t p = places(patched_.surface.corners[h]).*path;
  const std::uint32_t q = places(patched_.surface.corners[next_in_triangle(h)]).*path;
  return p != kNone && q != kNone && (p + 1 == q || q + 1 == p);
}

// Whether the border runs along the new path now, and nowhere else at the points of both paths.
bool PathMover::is_border(const Stretch& stretch) const {
  const std::vector<std::uint32_t>& path = corridor_.path();
  for (std::size_t i = 1; i < path.size(); ++i) {
    std::uint32_t patches[2] = {kNone, kNone}, count = 0;
    for_each_side(path[i - 1], path[i], [&](std::uint32_t t) {
      if (count < 2) patches[count++] = patched_.patch(t);
    });
    if (std::minmax(patches[0], patches[1]) != std::minmax(stretch.a, stretch.b)) return false;
  }
  for (std::size_t i = 1; i + 1 < path.size(); ++i)
    if (changes_around(path[i]) != 2) return false;
  for (std::size_t i = 1; i + 1 < stretch.path.size(); ++i)
    if (places(stretch.path[i]).in_new == kNone && changes_around(stretch.path[i]) != 0)
      return false;
  return true;
}

std::uint32_t PathMover::changes_around(std::uint32_t point) const {
  const std::uint32_t first = patched_.borders.spokes[point];
  std::uint32_t changes = 0;
  for (std::uint32_t h = first;;) {
    const std::uint32_t g = patched_.links.across_in_material(h);
    changes += patched_.patch(g / 3) != patched_.patch(h / 3);
    if (g / 3 == first / 3) return changes;
    h = other_spoke(patched_.surface, g, point);
  }
}

}  // namespace varifold
