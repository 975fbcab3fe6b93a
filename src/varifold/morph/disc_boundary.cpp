#include <varifold/base/angle.h>
#include <varifold/morph/disc_boundary.h>
#include <varifold/morph/sphere_triangulation.h>
#include <algorithm>
#include <array>
#include <cmath>

namespace varifold {
namespace {

constexpr double kShortestEdge = 0.01;  // of the mean
constexpr double kLongestEdge = 0.2;    // of the turn
constexpr int kHalvings = 8;

// The sign of the turn from p to q on the equator; exact.
int turn_sign(const SpherePoint& p, const SpherePoint& q) {
  return orientation({0, 0, std::int64_t{1} << 40}, p, q);
}
double turn_size(const SpherePoint& p, const SpherePoint& q) {
  return determinant({0, 0, std::int64_t{1} << 40}, p, q);
}

// Whether p comes before q on the way once around from (1, 0).
bool is_before(const SpherePoint& p, const SpherePoint& q) {
  const auto is_lower = [](const SpherePoint& r) { return r.y < 0 || (r.y == 0 && r.x < 0); };
  if (is_lower(p) != is_lower(q)) return is_lower(q);
  return turn_sign(p, q) > 0;
}

// Per point of the boundary, in its order, the half-edge that begins there.
std::vector<std::uint32_t> boundary_half_edges(const SphereSurface& surface) {
  const SphereTriangulation triangles(surface.indices,
                                      std::vector<SpherePoint>(surface.positions.size()));
  std::vector<std::uint32_t> half_from(surface.positions.size(), kNone), result;
  for (std::uint32_t h = 0; h < surface.indices.size(); ++h)
    if (triangles.opposite[h] == kNone) half_from[triangles.from(h)] = h;
  for (const std::uint32_t point : surface.boundary) result.push_back(half_from[point]);
  return result;
}

// Whether the boundary goes once around, strictly.
bool goes_around(const DiscMap& map) {
  const auto& boundary = map.disc.surface.boundary;
  int descents = 0;
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const SpherePoint &p = map.points[boundary[i]],
                      &q = map.points[boundary[(i + 1) % boundary.size()]];
    if (turn_sign(p, q) <= 0) return false;
    descents += !is_before(p, q);
  }
  return descents == 1;
}

// A place of the equator and the point of each disc that lies there.
struct SharedPlace {
  SpherePoint at;
  std::array<std::uint32_t, 2> points{kNone, kNone};
};

// All places once around. Where both have a point, that of b gets the very place of that of a.
std::vector<SharedPlace> places_of_both(const DiscMap& a, DiscMap& b) {
  std::vector<SharedPlace> all, places;
  for (const std::uint32_t point : a.disc.surface.boundary)
    all.push_back({a.points[point], {point, kNone}});
  for (const std::uint32_t point : b.disc.surface.boundary)
    all.push_back({b.points[point], {kNone, point}});
  std::stable_sort(all.begin(), all.end(), [](const SharedPlace& p, const SharedPlace& q) {
    return is_before(p.at, q.at);
  });
  for (const SharedPlace& place : all) {
    if (places.empty() || is_before(places.back().at, place.at)) {
      places.push_back(place);
      continue;
    }
    places.back().points[1] = place.points[1];  // those of a come first
    b.points[place.points[1]] = places.back().at;
  }
  return places;
}

// Gives one of both, the first or the second, a point at every place.
void cut_at_places(DiscMap& map, std::size_t which, std::vector<SharedPlace>& places) {
  const SphereSurface& surface = map.disc.surface;
  std::vector<std::uint32_t> half_from(map.points.size(), kNone);
  for (const std::uint32_t h : boundary_half_edges(surface)) half_from[surface.indices[h]] = h;
  std::size_t begin = 0;
  while (places[begin].points[which] == kNone) ++begin;
  std::vector<EdgeCut> cuts;
  auto next = static_cast<std::uint32_t>(map.points.size());
  std::uint32_t half_edge = kNone;
  for (std::size_t k = 0; k < places.size(); ++k) {
    SharedPlace& place = places[(begin + k) % places.size()];
    if (place.points[which] != kNone) {
      half_edge = half_from[place.points[which]];
      continue;
    }
    const SpherePoint& from = map.points[surface.indices[half_edge]];
    const SpherePoint& to = map.points[surface.indices[next_half_edge(half_edge)]];
    const double before = turn_size(from, place.at), after = turn_size(place.at, to);
    cuts.push_back({half_edge, kNone, before / (before + after)});
    place.points[which] = next++;
  }
  cut_edges(map.disc, cuts);
  map.points.resize(next);
}

}  // namespace

std::vector<std::uint32_t> capped_indices(const SphereSurface& surface) {
  std::vector<std::uint32_t> indices = surface.indices;
  const auto pole = static_cast<std::uint32_t>(surface.positions.size());
  const auto& boundary = surface.boundary;
  for (std::size_t i = 0; i < boundary.size(); ++i)
    indices.insert(indices.end(), {boundary[(i + 1) % boundary.size()], boundary[i], pole});
  return indices;
}

std::vector<SpherePoint> capped_points(std::span<const SpherePoint> points) {
  std::vector<SpherePoint> result(points.begin(), points.end());
  result.push_back(kSouthPole);
  return result;
}

SpherePoint equator_point(double turn) {
  constexpr std::uint64_t kSteps = std::uint64_t{1} << 52;
  const auto step = static_cast<std::uint64_t>(std::llround(turn * static_cast<double>(kSteps)));
  const glm::dvec2 way = unit_circle(step, kSteps);
  return {std::llround(way.x * kSphereRadius), std::llround(way.y * kSphereRadius), 0};
}

std::vector<double> boundary_turns(const SphereSurface& surface,
                                   std::span<const BoundaryAnchor> anchors) {
  const auto& boundary = surface.boundary;
  const std::size_t count = boundary.size();
  std::vector<double> length(count);
  double total = 0;
  for (std::size_t i = 0; i < count; ++i) {
    length[i] = glm::distance(DVec3(surface.positions[boundary[i]]),
                              DVec3(surface.positions[boundary[(i + 1) % count]]));
    total += length[i];
  }
  const double floor = std::max(kShortestEdge * total / static_cast<double>(count), 1e-300);
  for (double& edge : length) edge = std::max(edge, floor);

  // The anchors by their place in the loop; without any, the first point is one at 0.
  std::vector<std::pair<std::size_t, double>> fixed;
  for (std::size_t i = 0; i < count; ++i)
    for (const BoundaryAnchor& anchor : anchors)
      if (anchor.point == boundary[i]) fixed.emplace_back(i, anchor.at);
  if (fixed.empty()) fixed.emplace_back(0, 0.0);
  std::vector<double> turns(count);
  for (std::size_t f = 0; f < fixed.size(); ++f) {
    const auto [first, at] = fixed[f];
    const auto [end, at_end] = fixed[(f + 1) % fixed.size()];
    const std::size_t steps = first < end ? end - first : end + count - first;
    double span = at_end - at, whole = 0, walked = 0;
    if (span <= 0) span += 1;
    for (std::size_t i = 0; i < steps; ++i) whole += length[(first + i) % count];
    for (std::size_t i = 0; i < steps; ++i) {
      const double turn = at + span * walked / whole;
      turns[(first + i) % count] = turn < 1 ? turn : turn - 1;
      walked += length[(first + i) % count];
    }
  }
  return turns;
}

Result<void> lay_boundary(DiscMap& map, std::span<const BoundaryAnchor> anchors) {
  const SphereSurface& surface = map.disc.surface;
  std::vector<double> turns;
  for (int halving = 0; halving < kHalvings; ++halving) {
    turns = boundary_turns(surface, anchors);
    const std::vector<std::uint32_t> half_edges = boundary_half_edges(surface);
    std::vector<EdgeCut> cuts;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      double span = turns[(i + 1) % turns.size()] - turns[i];
      if (span <= 0) span += 1;
      if (span > kLongestEdge) cuts.push_back({half_edges[i], kNone, 0.5});
    }
    if (cuts.empty()) break;
    cut_edges(map.disc, cuts);
  }
  cut_chords(map.disc);
  map.points.assign(surface.positions.size(), SpherePoint());
  for (std::size_t i = 0; i < turns.size(); ++i)
    map.points[surface.boundary[i]] = equator_point(turns[i]);
  for (const BoundaryAnchor& anchor : anchors) map.points[anchor.point] = anchor.place;
  if (!goes_around(map))
    return fail(ErrorKind::kFailed, "edges of the boundary are too short for the sphere");
  return {};
}

SharedPoints merge_boundaries(DiscMap& a, DiscMap& b) {
  std::vector<SharedPlace> places = places_of_both(a, b);
  cut_at_places(a, 0, places);
  cut_at_places(b, 1, places);
  SharedPoints shared;
  shared.in_b.resize(a.points.size() + 1, kNone);
  shared.in_a.resize(b.points.size() + 1, kNone);
  shared.in_b.back() = static_cast<std::uint32_t>(b.points.size());
  shared.in_a.back() = static_cast<std::uint32_t>(a.points.size());
  for (const SharedPlace& place : places) {
    a.points[place.points[0]] = b.points[place.points[1]] = place.at;
    shared.in_b[place.points[0]] = place.points[1];
    shared.in_a[place.points[1]] = place.points[0];
  }
  return shared;
}

}  // namespace varifold
