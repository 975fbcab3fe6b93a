#include <varifold/base/angle.h>
#include <varifold/morph/disc_pair.h>
#include <varifold/morph/feature_warp.h>
#include <varifold/morph/sphere_embedding.h>
#include <algorithm>
#include <cmath>
#include <utility>

namespace varifold {
namespace {

// Per point its place in the boundary; kNone inside.
std::vector<std::uint32_t> places_on_boundary(const SphereSurface& surface) {
  std::vector<std::uint32_t> place(surface.positions.size(), kNone);
  for (std::uint32_t i = 0; i < surface.boundary.size(); ++i) place[surface.boundary[i]] = i;
  return place;
}

// Those on the boundary must come in one order.
Result<void> sort_features(DiscPair& pair, const std::vector<FeaturePoint>& features) {
  const std::vector<std::uint32_t> in_a = places_on_boundary(pair.maps[0].disc.surface),
                                   in_b = places_on_boundary(pair.maps[1].disc.surface);
  for (const FeaturePoint& pair_of : features) {
    const bool is_on_a = in_a[pair_of.first] != kNone, is_on_b = in_b[pair_of.second] != kNone;
    if (is_on_a != is_on_b)
      return fail(ErrorKind::kInvalidInput, std::string("a feature is on the boundary of the ") +
                                                (is_on_a ? "first mesh" : "second mesh") +
                                                " and inside the other one");
    auto& list = is_on_a ? pair.on_boundary : pair.inside;
    if (std::find(list.begin(), list.end(), pair_of) == list.end()) list.push_back(pair_of);
  }
  auto& on_boundary = pair.on_boundary;
  std::sort(
      on_boundary.begin(), on_boundary.end(),
      [&](const FeaturePoint& p, const FeaturePoint& q) { return in_a[p.first] < in_a[q.first]; });
  int descents = 0;
  for (std::size_t i = 0; i < on_boundary.size(); ++i)
    descents +=
        in_b[on_boundary[(i + 1) % on_boundary.size()].second] <= in_b[on_boundary[i].second];
  if (descents > 1)
    return fail(ErrorKind::kInvalidInput,
                "features on the boundary come in another order on the second mesh");
  return {};
}

// Turns the map. That rounds, which may fold the smallest triangles; then it is made once more.
Result<void> turn_by(DiscMap& map, const std::vector<std::uint32_t>& capped, double turn) {
  constexpr std::uint64_t kSteps = std::uint64_t{1} << 52;
  const glm::dvec2 way = unit_circle(
      static_cast<std::uint64_t>(std::llround(turn * static_cast<double>(kSteps))), kSteps);
  std::vector<SpherePoint> turned =
      rotated_points(map.points, {DVec3(way.x, -way.y, 0), DVec3(way.y, way.x, 0), DVec3(0, 0, 1)});
  if (count_flipped_on_sphere(capped, capped_points(turned)) == 0) {
    map.points = std::move(turned);
    return {};
  }
  const SphereSurface& surface = map.disc.surface;
  const BoundaryAnchor first{surface.boundary[0], turn, equator_point(turn)};
  if (auto laid = lay_boundary(map, {&first, 1}); !laid) return laid;
  auto points = embed_on_half_sphere(surface, map.points);
  if (!points) return tl::unexpected(std::move(points.error()));
  map.points = std::move(*points);
  return {};
}

}  // namespace

Result<void> lay_boundaries(DiscPair& pair, const std::vector<FeaturePoint>& features) {
  if (auto sorted = sort_features(pair, features); !sorted) return sorted;
  DiscMap &a = pair.maps[0], &b = pair.maps[1];
  if (auto laid = lay_boundary(a, {}); !laid) return fail_in("first mesh", std::move(laid.error()));
  std::vector<BoundaryAnchor> anchors;
  const std::vector<double> turns = boundary_turns(a.disc.surface, {});
  const std::vector<std::uint32_t> place = places_on_boundary(a.disc.surface);
  for (const auto& [in_a, in_b] : pair.on_boundary)
    anchors.push_back({in_b, turns[place[in_a]], a.points[in_a]});
  if (auto laid = lay_boundary(b, anchors); !laid)
    return fail_in("second mesh", std::move(laid.error()));
  return {};
}

Result<double> bring_together(DiscPair& pair) {
  DiscMap &map_a = pair.maps[0], &map_b = pair.maps[1];
  if (pair.on_boundary.empty()) {
    const SphereTriangulation a(capped_indices(map_a.disc.surface), capped_points(map_a.points)),
        b(capped_indices(map_b.disc.surface), capped_points(map_b.points));
    const SphereMap in_a{a, map_a.disc.surface.positions}, in_b{b, map_b.disc.surface.positions};
    const double turn = pair.inside.empty() ? align_discs(in_a, in_b)
                                            : align_disc_features(in_a, in_b, pair.inside);
    if (turn != 0)
      if (auto turned = turn_by(map_b, b.indices, turn); !turned)
        return fail_in("second mesh", std::move(turned.error()));
  }
  if (pair.inside.empty()) return 0.0;
  CappedDisc moved = capped(map_b);
  std::vector<Pin> pins;
  pins.reserve(pair.inside.size());
  for (const auto& [in_a, in_b] : pair.inside) pins.push_back({in_b, map_a.points[in_a]});
  const MutableSphereMap map{moved.surface.indices, moved.surface.positions, moved.points,
                             &moved.is_fixed};
  const double farthest = drag_to_goals(map, pins).farthest;
  moved.points.pop_back();
  map_b.points = std::move(moved.points);
  return farthest;
}

CappedDisc capped(DiscMap map) {
  CappedDisc result{
      std::move(map.disc.mesh), std::move(map.disc.surface), capped_points(map.points), {}};
  SphereSurface& surface = result.surface;
  result.is_fixed.resize(result.points.size(), false);
  for (const std::uint32_t point : surface.boundary) result.is_fixed[point] = true;
  result.is_fixed.back() = true;
  surface.indices = capped_indices(surface);
  surface.positions.push_back(surface.positions[surface.boundary[0]]);
  return result;
}

}  // namespace varifold
