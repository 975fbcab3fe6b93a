#include <varifold/morph/star_relaxation.h>
#include <varifold/morph/tangent_frame.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace varifold {
namespace {

using glm::dvec2;

// Half the side of the square of the tangent plane that a kernel is looked for in.
constexpr double kKernelReach = 8;
// Twice the area of a triangle on the sphere over its squared edges, at least, with a lift.
constexpr double kNeedle = 1e-6;
// The part of the floor that counts on the surface of the lift.
constexpr double kLiftedFloor = 1e-4;
constexpr double kMostBits = 20;

// Cuts a convex polygon with the half-plane c + g . x > 0.
void clip(const std::vector<dvec2>& polygon, double c, const dvec2& g, std::vector<dvec2>& result) {
  result.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double at_p = c + glm::dot(g, p), at_q = c + glm::dot(g, q);
    if (at_p > 0) result.push_back(p);
    if ((at_p > 0) != (at_q > 0)) result.push_back(p + (at_p / (at_p - at_q)) * (q - p));
  }
}

}  // namespace

bool is_star_positive(std::span<const SpherePoint> points, std::span<const std::uint32_t> ring,
                      const SpherePoint& point) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::size_t next = i + 1 == ring.size() ? 0 : i + 1;
    if (!(determinant(point, points[ring[i]], points[ring[next]]) > 0)) return false;
  }
  return true;
}

StarRelaxation::StarRelaxation(const RingMesh& mesh, std::span<const Vec3> positions,
                               std::span<SpherePoint> points)
    : mesh_(mesh), positions_(positions), points_(points) {}

void StarRelaxation::gather(std::uint32_t vertex) {
  const auto ring = mesh_.ring(vertex);
  corners_.resize(ring.size());
  const DVec3 origin(positions_[vertex]);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const DVec3 u = DVec3(positions_[ring[i]]) - origin;
    const DVec3 v = DVec3(positions_[ring[(i + 1) % ring.size()]]) - origin;
    Corner& corner = corners_[i];
    corner.place = direction(points_[ring[i]]);
    corner.lifted = lift_ ? lifted_[ring[i]] : corner.place;
    corner.uu = glm::dot(u, u) + floor_;
    corner.uv = glm::dot(u, v) + 0.5 * floor_;
    corner.vv = glm::dot(v, v) + floor_;
    corner.area = 0.5 * std::sqrt(std::max(0.0, corner.uu * corner.vv - corner.uv * corner.uv));
  }
}

// Sum over the star of (r + 1/r) (g + 1/g): r is the ratio of the singular values of the map
// between the flat triangles, g their product in proportion to the areas of the whole. Weighted by
// the area on the surface, with a lift by the mean of both areas. Infinite where a triangle is not
// positive.
double StarRelaxation::distortion_at(const DVec3& point, const DVec3& lifted, double most) const {
  double sum = 0;
  const double floor = lift_ ? kLiftedFloor * floor_ / scale_ : 0.0;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Corner& corner = corners_[i];
    const Corner& next = corners_[i + 1 == corners_.size() ? 0 : i + 1];
    if (!is_positive(corner.place - point, next.place - point, point))
      return std::numeric_limits<double>::infinity();
    const DVec3 u = corner.lifted - lifted, v = next.lifted - lifted;
    const double uu = glm::dot(u, u) + floor, uv = glm::dot(u, v) + 0.5 * floor,
                 vv = glm::dot(v, v) + floor;
    const double trace = vv * corner.uu - 2 * uv * corner.uv + uu * corner.vv;
    const double twice_area = std::sqrt(std::max(uu * vv - uv * uv, 1e-300));
    const double growth = 2 * corner.area / (twice_area * scale_);
    const double weight = lift_ ? 0.5 * (1 + 1 / growth) : 1.0;
    sum += weight * trace / twice_area * (growth + 1 / growth);
    if (sum > most) return sum;
  }
  return sum;
}

// With a lift nothing else keeps triangles from becoming needles on the sphere, among which no more
// vertices would find a place.
bool StarRelaxation::is_positive(const DVec3& u, const DVec3& v, const DVec3& point) const {
  const DVec3 normal = glm::cross(u, v);
  if (!lift_) return glm::dot(normal, point) > 0;
  const double edges = glm::dot(u, u) + glm::dot(v, v) + glm::dot(u - v, u - v);
  return glm::dot(normal, point) > kNeedle * edges;
}

void StarRelaxation::set_lift(const SurfaceLift* lift) {
  lift_ = lift;
  lifted_.clear();
  hints_.clear();
  if (!lift) return;
  lifted_.resize(points_.size());
  hints_.assign(points_.size(), 0);
  std::uint32_t hint = 0;
  for (std::uint32_t v = 0; v < points_.size(); ++v) {
    if (!mesh_.is_live(v)) continue;
    // From a neighbour it is not far to walk.
    for (const std::uint32_t neighbour : mesh_.ring(v))
      if (neighbour < v) hint = hints_[neighbour];
    lifted_[v] = lift_->at(glm::normalize(direction(points_[v])), hint);
    hints_[v] = hint;
  }
}

StarRelaxation::Trial StarRelaxation::trial_at(const DVec3& point, std::uint32_t hint,
                                               double most) const {
  Trial trial{point, point, hint, 0};
  if (lift_) trial.lifted = lift_->at(point, trial.hint);
  trial.distortion = distortion_at(point, trial.lifted, most);
  return trial;
}

bool StarRelaxation::accept(std::uint32_t vertex, const DVec3& point) {
  const SpherePoint rounded = to_sphere_point(point);
  if (!is_star_positive(points_, mesh_.ring(vertex), rounded)) return false;
  move_to(vertex, rounded);
  return true;
}

void StarRelaxation::move_to(std::uint32_t vertex, const SpherePoint& point) {
  points_[vertex] = point;
  if (lift_) lifted_[vertex] = lift_->at(glm::normalize(direction(point)), hints_[vertex]);
}

double StarRelaxation::nearest_corner(const DVec3& point) const {
  double nearest = 4;
  for (const Corner& corner : corners_)
    nearest = std::min(nearest, glm::distance(corner.place, point));
  return nearest;
}

// Places all over the star: on its spokes and between them.
void StarRelaxation::try_star(Trial& best) const {
  const Trial center = best;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const DVec3& p = corners_[i].place;
    const DVec3 middle = 0.5 * (p + corners_[i + 1 == corners_.size() ? 0 : i + 1].place);
    for (const double part : {0.1, 0.3, 0.6, 0.85})
      for (const DVec3& to : {p, middle}) {
        const DVec3 point = glm::normalize(center.point + part * (to - center.point));
        const Trial trial = trial_at(point, center.hint, best.distortion);
        if (trial.distortion < best.distortion) best = trial;
      }
  }
}

double StarRelaxation::relax(std::uint32_t vertex, int rounds, Reach reaching) {
  gather(vertex);
  const DVec3 start = direction(points_[vertex]);
  Trial best = trial_at(start, lift_ ? hints_[vertex] : 0);
  if (reaching == Reach::kStar) try_star(best);
  double reach = 0.25 * nearest_corner(best.point);
  for (int round = 0; round < rounds; ++round) {
    const auto [u, v] = tangent_frame(best.point);
    const Trial center = best;
    const auto try_at = [&](const DVec3& point) {
      const Trial trial = trial_at(point, center.hint);
      if (trial.distortion < best.distortion) best = trial;
      return trial.distortion;
    };
    dvec2 jump(0);
    for (int axis = 0; axis < 2; ++axis) {
      const DVec3 way = reach * (axis == 0 ? u : v);
      const double ahead = try_at(center.point + way), behind = try_at(center.point - way);
      const double bend = ahead + behind - 2 * center.distortion;
      if (bend > 0 && std::isfinite(bend))
        jump[axis] = std::clamp(0.5 * (behind - ahead) / bend, -2.0, 2.0);
    }
    try_at(center.point + reach * (jump.x * u + jump.y * v));
    const bool is_better = best.distortion < center.distortion;
    if (is_better) best.point = glm::normalize(best.point);
    reach *= is_better ? 0.7 : 0.25;
  }
  if (best.point == start || !accept(vertex, best.point)) return 0;
  return glm::distance(best.point, start);
}

void StarRelaxation::drag(std::uint32_t vertex, const SpherePoint& goal) {
  if (points_[vertex] == goal) return;
  const auto ring = mesh_.ring(vertex);
  if (is_star_positive(points_, ring, goal)) {
    move_to(vertex, goal);
    return;
  }
  const DVec3 from = direction(points_[vertex]);
  DVec3 to = direction(goal);
  // Straight across the sphere there is no shortest way.
  if (glm::dot(from, to) < -0.99) to += 0.2 * tangent_frame(from).first;
  double part = 0.5;
  for (int halving = 0; halving < 24; ++halving, part *= 0.5) {
    if (!is_star_positive(points_, ring, to_sphere_point(from + part * (to - from)))) continue;
    accept(vertex, from + 0.5 * part * (to - from));
    return;
  }
}

double StarRelaxation::mean_distortion() {
  double sum = 0, weights = 0;
  for (std::uint32_t v = 0; v < points_.size(); ++v) {
    if (!mesh_.is_live(v)) continue;
    gather(v);
    const auto ring = mesh_.ring(v);
    const std::vector<Corner> star = corners_;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::size_t next = i + 1 == ring.size() ? 0 : i + 1;
      if (v > ring[i] || v > ring[next]) continue;  // told by another corner
      const DVec3 u = star[i].lifted - lifted_[v], w = star[next].lifted - lifted_[v];
      const double twice_area = glm::length(glm::cross(u, w)) + 1e-300;
      const double trace = glm::dot(w, w) * star[i].uu - 2 * glm::dot(u, w) * star[i].uv +
                           glm::dot(u, u) * star[i].vv;
      const double ratios = 0.5 * trace / (twice_area * star[i].area + 1e-300);
      const double growth = 2 * star[i].area / (twice_area * scale_) + 1e-300;
      const double weight = star[i].area + 0.5 * twice_area * scale_;
      const double bits = std::log2(ratios * (growth + 1 / growth) / 4);
      sum += weight * std::clamp(bits, 0.0, kMostBits);
      weights += weight;
    }
  }
  return weights > 0 ? sum / weights : 0;
}

bool StarRelaxation::place(std::uint32_t vertex) {
  if (lift_) hints_[vertex] = hints_[mesh_.ring(vertex)[0]];
  if (!place_in_kernel(vertex) && !place_near_target(vertex)) return false;
  relax(vertex, 6, lift_ ? Reach::kStar : Reach::kNear);
  return true;
}

// The middle of the region that sees the whole ring, in the tangent plane at ring[0].
bool StarRelaxation::place_in_kernel(std::uint32_t vertex) {
  const auto ring = mesh_.ring(vertex);
  const DVec3 origin = direction(points_[ring[0]]);
  const auto [u, v] = tangent_frame(origin);
  kernel_.assign({dvec2(-kKernelReach, -kKernelReach), dvec2(kKernelReach, -kKernelReach),
                  dvec2(kKernelReach, kKernelReach), dvec2(-kKernelReach, kKernelReach)});
  for (std::size_t i = 0; i < ring.size() && !kernel_.empty(); ++i) {
    const DVec3 p = direction(points_[ring[i]]);
    const DVec3 q = direction(points_[ring[(i + 1) % ring.size()]]);
    const DVec3 normal = glm::cross(p, q - p);
    const bool at_origin = i == 0 || i + 1 == ring.size();
    const double c = at_origin ? 0.0 : glm::dot(normal, origin - p);
    clip(kernel_, c, dvec2(glm::dot(normal, u), glm::dot(normal, v)), clipped_);
    kernel_.swap(clipped_);
  }
  if (kernel_.size() < 3) return false;
  dvec2 middle(0);
  for (const dvec2& corner : kernel_) middle += corner;
  middle /= static_cast<double>(kernel_.size());
  return accept(vertex, origin + middle.x * u + middle.y * v);
}

// Close to ring[0], on the bisector of the ring's angle there: right, if it is close enough.
bool StarRelaxation::place_near_target(std::uint32_t vertex) {
  const auto ring = mesh_.ring(vertex);
  const DVec3 origin = direction(points_[ring[0]]);
  const auto [u, v] = tangent_frame(origin);
  std::array<dvec2, 2> ways;
  for (int side = 0; side < 2; ++side) {
    const DVec3 way = direction(points_[side == 0 ? ring[1] : ring.back()]) - origin;
    ways[side] = glm::normalize(dvec2(glm::dot(way, u), glm::dot(way, v)));
  }
  dvec2 bisector = ways[0] + ways[1];
  const double turn = ways[0].x * ways[1].y - ways[0].y * ways[1].x;
  if (glm::dot(bisector, bisector) < 1e-12)
    bisector = dvec2(-ways[0].y, ways[0].x);
  else if (turn < 0)
    bisector = -bisector;
  bisector = glm::normalize(bisector);
  for (double reach = 0.25; reach > 0x1.0p-40; reach *= 0.5)
    if (accept(vertex, origin + reach * (bisector.x * u + bisector.y * v))) return true;
  return false;
}

}  // namespace varifold
