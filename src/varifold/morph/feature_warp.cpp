// Based on: [Alexa2000] for moving features together step by step, with checks for folds.
// Differs: signs are exact, and the rest of the map is relaxed by its stretch.
#include <varifold/base/random.h>
#include <varifold/morph/feature_warp.h>
#include <varifold/morph/star_relaxation.h>
#include <varifold/morph/tangent_frame.h>
#include <algorithm>
#include <cmath>

namespace varifold {
namespace {

constexpr std::uint32_t kMostRounds = 1000;
constexpr std::uint32_t kPatience = 60;

double distance_to_goal(const SpherePoint& from, const SpherePoint& to) {
  return from == to ? 0.0 : glm::distance(direction(from), direction(to));
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

}  // namespace

WarpReport drag_to_goals(const MutableSphereMap& map, std::span<const Pin> pins) {
  WarpReport report;
  const auto count = static_cast<std::uint32_t>(map.points.size());
  const RingMesh mesh(map.indices, count);
  StarRelaxation relaxation(mesh, map.positions, map.points);
  std::vector<bool> is_pinned(count, false);
  for (const Pin& pin : pins) is_pinned[pin.vertex] = true;
  double nearest_sum = 1e300;
  for (std::uint32_t waiting = 0; report.rounds < kMostRounds && waiting < kPatience;) {
    double sum = 0;
    report.farthest = 0;
    for (const Pin& pin : pins) {
      drag(mesh, map.points, pin);
      const double left = distance_to_goal(map.points[pin.vertex], pin.goal);
      sum += left;
      report.farthest = std::max(report.farthest, left);
    }
    if (sum == 0) break;
    waiting = sum < 0.999 * nearest_sum ? 0 : waiting + 1;
    nearest_sum = std::min(nearest_sum, sum);
    for (std::uint32_t v = 0; v < count; ++v)
      if (!is_pinned[v]) relaxation.relax(v, 2);
    ++report.rounds;
  }
  return report;
}

void jitter(const MutableSphereMap& map, double reach, std::uint64_t seed) {
  const auto count = static_cast<std::uint32_t>(map.points.size());
  const RingMesh mesh(map.indices, count);
  Random random(seed);
  for (std::uint32_t v = 0; v < count; ++v) {
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
