#include <varifold/models/patch_tree/border_guard.h>

#include <varifold/base/parallel.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <varifold/simplify/classify.h>
#include <algorithm>
#include <array>

namespace varifold {

namespace {

// The cosine of the greatest turn of a triangle by a switch: that of any collapse.
constexpr float kMinCosine = 0.2588f;
// 2 * area / longest edge^2 of a switched triangle, unless it was below before.
constexpr float kMinShape = 1e-3f;
constexpr std::size_t kPointsPerPiece = 1024;

using Corners = std::array<Vec3, 3>;

float shape_of(const Corners& p, float doubled_area_squared) {
  const Vec3 a = p[1] - p[0], b = p[2] - p[1], c = p[0] - p[2];
  const float longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
  return longest > 0 ? doubled_area_squared / (longest * longest) : 0;
}

// Whether a triangle turns by 75 degrees at most, and is no needle then unless it was one.
bool keeps_shape(const Corners& before, const Corners& after) {
  const Vec3 old_normal = glm::cross(before[1] - before[0], before[2] - before[0]);
  const Vec3 new_normal = glm::cross(after[1] - after[0], after[2] - after[0]);
  const float old_square = glm::dot(old_normal, old_normal);
  const float new_square = glm::dot(new_normal, new_normal);
  const float cosine = glm::dot(old_normal, new_normal);
  if (old_square > 0 &&
      (cosine <= 0 || (cosine / old_square) * (cosine / new_square) < kMinCosine * kMinCosine))
    return false;
  const float shape = shape_of(after, new_square);
  return shape >= kMinShape * kMinShape || shape >= shape_of(before, old_square);
}

std::pair<std::uint32_t, std::uint32_t> sorted_pair(std::uint32_t a, std::uint32_t b) {
  return a < b ? std::pair(a, b) : std::pair(b, a);
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

template <class T>
void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

void BorderGuard::begin_level(const BorderLocks& locks, std::span<const std::uint32_t> live) {
  for (const BorderPoint& p : points_) border_of_[p.point] = kNone;
  points_.clear();
  star_.clear();
  forbidden_ = locks.edges;
  for (const std::uint32_t p : live)
    if (surface_.points[p].kind != VertexKind::kManifold) add_point(p);
  limit_controllers();
  for (const std::uint32_t p : locks.points) surface_.points[p].kind = VertexKind::kCorner;
}

// Remembers the faces around a point where regions meet.
void BorderGuard::add_point(std::uint32_t point) {
  const auto ring = surface_.ring_span(point);
  const auto first = static_cast<std::uint32_t>(star_.size());
  std::uint32_t regions[2] = {kNone, kNone};
  bool more = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i].face == kNone) continue;
    const std::uint32_t region = surface_.region_of[ring[i].face];
    const std::uint32_t next = ring[i + 1 == ring.size() ? 0 : i + 1].neighbor;
    star_.push_back({ring[i].neighbor, next, region});
    if (regions[0] == kNone || regions[0] == region)
      regions[0] = region;
    else if (regions[1] == kNone || regions[1] == region)
      regions[1] = region;
    else
      more = true;
  }
  if (regions[1] == kNone) return star_.resize(first);
  if (more) regions[0] = regions[1] = kNone;
  const auto number = static_cast<std::uint32_t>(points_.size());
  border_of_[point] = number;
  points_.push_back({point,
                     first,
                     static_cast<std::uint32_t>(star_.size()),
                     {regions[0], regions[1]},
                     number,
                     kNone,
                     number});
}

// A region with more neighbours than there are bits leaves its borders with the last of them alone.
void BorderGuard::limit_controllers() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const BorderPoint& p : points_) {
    if (p.regions[0] == kNone || surface_.points[p.point].kind == VertexKind::kCorner) continue;
    pairs.emplace_back(p.regions[0], p.regions[1]);
    pairs.emplace_back(p.regions[1], p.regions[0]);
  }
  sort_unique(pairs);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> too_many;
  std::size_t first = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].first != pairs[first].first) first = i;
    if (i - first >= kMaxControllers)
      too_many.push_back(sorted_pair(pairs[i].first, pairs[i].second));
  }
  if (too_many.empty()) return;
  sort_unique(too_many);
  for (const BorderPoint& p : points_)
    if (p.regions[0] != kNone && std::binary_search(too_many.begin(), too_many.end(),
                                                    sorted_pair(p.regions[0], p.regions[1])))
      surface_.points[p.point].kind = VertexKind::kCorner;
}

void BorderGuard::lock_all() {
  for (const BorderPoint& p : points_) surface_.points[p.point].kind = VertexKind::kCorner;
}

void BorderGuard::join(std::uint32_t from, std::uint32_t onto) {
  for (std::uint32_t i = from; i != kNone; i = points_[i].next) points_[i].target = onto;
  points_[points_[onto].last].next = from;
  points_[onto].last = points_[from].last;
}

void BorderGuard::part(std::uint32_t from, std::uint32_t onto, std::uint32_t last_of_onto) {
  points_[onto].last = last_of_onto;
  points_[last_of_onto].next = kNone;
  for (std::uint32_t i = from; i != kNone; i = points_[i].next) points_[i].target = from;
}

bool BorderGuard::may_join(std::uint32_t from, std::uint32_t onto) {
  if (forbidden_.empty()) return true;
  for (const RingEntry& entry : surface_.ring_span(from))
    if (std::binary_search(forbidden_.begin(), forbidden_.end(), sorted_pair(entry.neighbor, onto)))
      return false;
  return true;
}

bool BorderGuard::allows(std::uint32_t from, std::uint32_t onto) {
  if (!may_join(from, onto)) return false;
  const std::uint32_t b = border_of_[from];
  if (b == kNone) return true;
  const std::uint32_t target = border_of_[onto];
  const std::uint32_t regions[2] = {points_[b].regions[0], points_[b].regions[1]};
  if (target == kNone || regions[0] == kNone) return false;
  const std::uint32_t last = points_[target].last;
  join(b, target);
  thread_local Link link;  // so that its memory is kept
  const bool sound = is_sound(target, regions[0], link) && is_sound(target, regions[1], link) &&
                     (points_[target].regions[0] != kNone || is_free_of_clashes(target));
  part(b, target, last);
  return sound;
}

void BorderGuard::collapsed(std::uint32_t from, std::uint32_t onto) {
  join(border_of_[from], border_of_[onto]);
}

std::uint32_t BorderGuard::image(std::uint32_t point, std::uint32_t region,
                                 const Mixture& mixture) const {
  const std::uint32_t border = border_of_[point];
  if (border == kNone) return point;
  const BorderPoint& p = points_[border];
  if (p.target == border || !mixture.has(p.other_than(region))) return point;
  return points_[p.target].point;
}

// The neighbours that can move a corner of the faces that can come to lie around the target. False
// where they are too many.
bool BorderGuard::gather_controllers(std::uint32_t target, std::uint32_t region,
                                     Mixture& mixture) const {
  const auto add = [&](std::uint32_t point) {
    const std::uint32_t c = controller(point, region);
    if (c == kNone) return true;
    for (std::size_t i = 0; i < mixture.count; ++i)
      if (mixture.controllers[i] == c) return true;
    if (mixture.count == Mixture::kMax) return false;
    mixture.controllers[mixture.count++] = c;
    return true;
  };
  for (std::uint32_t i = target; i != kNone; i = points_[i].next)
    for (const StarFace& face : star(points_[i]))
      if (face.region == region && !(add(points_[i].point) && add(face.from) && add(face.to)))
        return false;
  return true;
}

bool BorderGuard::is_sound(std::uint32_t target, std::uint32_t region, Link& link) const {
  Mixture mixture;
  const int fans = count_fans(target, region, mixture, link);
  if (fans < 0 || !gather_controllers(target, region, mixture)) return false;
  for (mixture.coarse = 1; mixture.coarse < 1u << mixture.count; ++mixture.coarse)
    if (count_fans(target, region, mixture, link) != fans || !keeps_shapes(target, region, mixture))
      return false;
  return true;
}

// How many fans the faces of a region form around the target; -1 where they form something else.
int BorderGuard::count_fans(std::uint32_t target, std::uint32_t region, const Mixture& mixture,
                            Link& link) const {
  const std::uint32_t apex = points_[target].point;
  link.clear();
  for (std::uint32_t i = target; i != kNone; i = points_[i].next) {
    if (image(points_[i].point, region, mixture) != apex) continue;
    for (const StarFace& face : star(points_[i])) {
      if (face.region != region) continue;
      const std::uint32_t from = image(face.from, region, mixture);
      const std::uint32_t to = image(face.to, region, mixture);
      if (from != apex && to != apex && from != to) link.emplace_back(from, to);
    }
  }
  return count_paths(link);
}

// The number of paths that the directed edges of a link form; -1 where an end repeats or a path
// closes beside others.
int BorderGuard::count_paths(const Link& link) {
  const std::size_t size = link.size();
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (link[j].first == link[i].first || link[j].second == link[i].second) return -1;
  const auto leaving = [&](std::uint32_t end) {
    return std::find_if(link.begin(), link.end(),
                        [&](const auto& edge) { return edge.first == end; });
  };
  int paths = 0;
  std::size_t walked = 0;
  for (const auto& first : link) {
    const bool is_start = std::none_of(
        link.begin(), link.end(), [&](const auto& edge) { return edge.second == first.first; });
    if (!is_start) continue;
    ++paths;
    for (auto edge = leaving(first.first); edge != link.end(); edge = leaving(edge->second))
      ++walked;
  }
  return walked == size ? paths : -1;
}

bool BorderGuard::keeps_shapes(std::uint32_t target, std::uint32_t region,
                               const Mixture& mixture) const {
  if (!keeps_shapes_in(RestPlaces(surface_), target, region, mixture)) return false;
  for (std::uint32_t i = 0; poses_ && i < poses_->pose_count(); ++i)
    if (!keeps_shapes_in(poses_->pose(i), target, region, mixture)) return false;
  return true;
}

template <class Places>
bool BorderGuard::keeps_shapes_in(const Places& places, std::uint32_t target, std::uint32_t region,
                                  const Mixture& mixture) const {
  const auto position = [&](std::uint32_t point) { return places.position(point); };
  for (std::uint32_t i = target; i != kNone; i = points_[i].next) {
    const std::uint32_t apex = points_[i].point;
    const std::uint32_t new_apex = image(apex, region, mixture);
    for (const StarFace& face : star(points_[i])) {
      if (face.region != region) continue;
      const std::uint32_t from = image(face.from, region, mixture);
      const std::uint32_t to = image(face.to, region, mixture);
      if (from == to || from == new_apex || to == new_apex) continue;
      if (from == face.from && to == face.to && new_apex == apex) continue;
      if (!keeps_shape({position(apex), position(face.from), position(face.to)},
                       {position(new_apex), position(from), position(to)}))
        return false;
    }
  }
  return true;
}

bool BorderGuard::verify(BorderLocks& locks, int threads) const {
  struct Piece {
    bool is_sound = true;
    std::vector<Chord> chords;
    BorderLocks locks;
  };
  std::vector<Piece> pieces((points_.size() + kPointsPerPiece - 1) / kPointsPerPiece);
  parallel_for(threads, points_.size(), kPointsPerPiece, [&](std::size_t begin, std::size_t end) {
    Piece& piece = pieces[begin / kPointsPerPiece];
    piece.is_sound = verify_some(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end),
                                 piece.chords, piece.locks);
  });
  bool sound = true;
  std::vector<Chord> chords;
  std::size_t count = 0;
  for (const Piece& piece : pieces) count += piece.chords.size();
  chords.reserve(count);
  for (Piece& piece : pieces) {
    sound &= piece.is_sound;
    append(chords, piece.chords);
    append(locks.points, piece.locks.points);
    piece = {};
  }
  sound &= !lock_chords(chords, locks);
  sort_unique(locks.points);
  sort_unique(locks.edges);
  return sound;
}

// The mixtures around some border points; gathers their chords.
bool BorderGuard::verify_some(std::uint32_t begin, std::uint32_t end, std::vector<Chord>& chords,
                              BorderLocks& locks) const {
  bool sound = true;
  Link link;
  std::vector<std::uint32_t> regions;
  for (std::uint32_t b = begin; b < end; ++b) {
    find_chords(b, false, chords);
    if (points_[b].target != b) continue;
    find_new_chords(b, chords);
    if (points_[b].next == kNone) continue;  // nothing came here
    regions.clear();
    for (const StarFace& face : star(points_[b])) regions.push_back(face.region);
    sort_unique(regions);
    for (const std::uint32_t region : regions)
      if (!is_sound(b, region, link)) {
        sound = false;
        lock_around(b, locks);
      }
  }
  return sound;
}

void BorderGuard::lock_around(std::uint32_t target, BorderLocks& locks) const {
  const auto lock = [&](std::uint32_t point) {
    const std::uint32_t b = border_of_[point];
    if (b != kNone && points_[b].target != b) locks.points.push_back(point);
  };
  for (std::uint32_t i = target; i != kNone; i = points_[i].next) {
    lock(points_[i].point);
    for (const StarFace& face : star(points_[i])) lock(face.from), lock(face.to);
  }
}

}  // namespace varifold
