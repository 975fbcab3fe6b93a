// Based on: [Alexa2000] for moving features together step by step, with checks for folds.
// Differs: signs are exact, and the rest of the map is relaxed by its stretch.
#include <varifold/base/random.h>
#include <varifold/morph/feature_warp.h>
#include <varifold/morph/star_relaxation.h>
#include <varifold/morph/tangent_frame.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace varifold {
namespace {

constexpr std::uint32_t kMostRounds = 300;
constexpr std::uint32_t kPatience = 40;
constexpr double kLongestStep = 0.1;  // radians
constexpr double kDragged = 0.01;

double distance_to_goal(const SpherePoint& from, const SpherePoint& to) {
  return from == to ? 0.0 : glm::distance(direction(from), direction(to));
}

double area_of(const MutableSphereMap& map) {
  double area = 0;
  for (std::size_t t = 0; t + 2 < map.indices.size(); t += 3) {
    if (!map.may_move(map.indices[t]) && !map.may_move(map.indices[t + 1]) &&
        !map.may_move(map.indices[t + 2]))
      continue;  // of the fan that closes a disc
    const DVec3 a(map.positions[map.indices[t]]), b(map.positions[map.indices[t + 1]]),
        c(map.positions[map.indices[t + 2]]);
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return area;
}

// As far as the star allows; whole, halves, quarters of the way.
void drag(const RingMesh& mesh, std::span<SpherePoint> points, const Pin& pin) {
  SpherePoint& point = points[pin.vertex];
  if (point == pin.goal) return;
  const auto ring = mesh.ring(pin.vertex);
  if (is_star_positive(points, ring, pin.goal)) {
    point = pin.goal;
    return;
  }
  const DVec3 from = direction(point);
  DVec3 to = direction(pin.goal);
  // Straight across the sphere there is no shortest way.
  if (glm::dot(from, to) < -0.99) to += 0.2 * tangent_frame(from).first;
  double part = 0.5;
  for (int halving = 0; halving < 24; ++halving, part *= 0.5) {
    const SpherePoint next = to_sphere_point(from + part * (to - from));
    if (!is_star_positive(points, ring, next)) continue;
    // Half of what is possible leaves the triangles ahead something to give way with.
    const SpherePoint half = to_sphere_point(from + 0.5 * part * (to - from));
    if (is_star_positive(points, ring, half)) point = half;
    return;
  }
}

// The whole sphere flows with the pins: each vertex by the means of their ways, weighted by the
// fourth power of the inverse distance; of a disc less and less below the lowest pin, and nothing
// on the boundary. False, and nothing moves, where a triangle would fold.
bool flow(const MutableSphereMap& map, std::span<const Pin> pins, double part) {
  std::vector<SpherePoint> moved(map.points.begin(), map.points.end());
  double lowest = 1;
  for (const Pin& pin : pins) lowest = std::min(lowest, direction(map.points[pin.vertex]).z);
  for (std::uint32_t v = 0; v < moved.size(); ++v) {
    if (!map.may_move(v)) continue;
    const DVec3 point = direction(map.points[v]);
    DVec3 way(0);
    double weights = 0;
    for (const Pin& pin : pins) {
      const DVec3 from = direction(map.points[pin.vertex]);
      const DVec3 gap = point - from;
      const double square = glm::dot(gap, gap) + 1e-12;
      const double weight = 1 / (square * square);
      way += weight * (direction(pin.goal) - from);
      weights += weight;
    }
    if (map.is_fixed != nullptr) way *= std::min(1.0, point.z / lowest);
    moved[v] = to_sphere_point(point + part / weights * way);
  }
  if (part == 1)
    for (const Pin& pin : pins) moved[pin.vertex] = pin.goal;
  for (std::size_t t = 0; t + 2 < map.indices.size(); t += 3)
    if (orientation(moved[map.indices[t]], moved[map.indices[t + 1]], moved[map.indices[t + 2]]) <=
        0)
      return false;
  std::copy(moved.begin(), moved.end(), map.points.begin());
  return true;
}

// How far pins are from their goals: the farthest, and all together.
std::pair<double, double> distances(const MutableSphereMap& map, std::span<const Pin> pins) {
  double farthest = 0, sum = 0;
  for (const Pin& pin : pins) {
    const double left = distance_to_goal(map.points[pin.vertex], pin.goal);
    sum += left;
    farthest = std::max(farthest, left);
  }
  return {farthest, sum};
}

}  // namespace

WarpReport drag_to_goals(const MutableSphereMap& map, std::span<const Pin> pins) {
  WarpReport report;
  const auto count = static_cast<std::uint32_t>(map.points.size());
  const RingMesh mesh(map.indices, count);
  StarRelaxation relaxation(mesh, map.positions, map.points);
  relaxation.set_scale(area_of(map) / ((map.is_fixed == nullptr ? 4 : 2) * std::numbers::pi));
  std::vector<bool> is_pinned(count, false);
  for (const Pin& pin : pins) is_pinned[pin.vertex] = true;
  double nearest_sum = 1e300;
  for (std::uint32_t waiting = 0; report.rounds < kMostRounds && waiting < kPatience;
       ++report.rounds) {
    const auto [farthest, sum] = distances(map, pins);
    if (sum == 0) break;
    waiting = sum < 0.999 * nearest_sum ? 0 : waiting + 1;
    nearest_sum = std::min(nearest_sum, sum);
    double part = std::min(1.0, kLongestStep / farthest);
    bool has_flowed = flow(map, pins, part);
    for (int halving = 0; halving < 6 && !has_flowed; ++halving)
      has_flowed = flow(map, pins, part *= 0.5);
    // Alone a vertex gets as far as its star, which takes all the room that flowing needs.
    if (!has_flowed || farthest < kDragged)
      for (const Pin& pin : pins) drag(mesh, map.points, pin);
    for (std::uint32_t v = 0; v < count; ++v)
      if (!is_pinned[v] && map.may_move(v)) relaxation.relax(v, 2);
  }
  report.farthest = distances(map, pins).first;
  return report;
}

void jitter(const MutableSphereMap& map, double reach, std::uint64_t seed) {
  const auto count = static_cast<std::uint32_t>(map.points.size());
  const RingMesh mesh(map.indices, count);
  Random random(seed);
  for (std::uint32_t v = 0; v < count; ++v) {
    if (!map.may_move(v)) continue;
    const DVec3 point = direction(map.points[v]);
    DVec3 way(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    way *= 2 * reach;
    for (int halving = 0; halving < 8; ++halving, way *= 0.5) {
      const SpherePoint next = to_sphere_point(point + way);
      if (!is_star_positive(map.points, mesh.ring(v), next)) continue;
      map.points[v] = next;
      break;
    }
  }
}

}  // namespace varifold
