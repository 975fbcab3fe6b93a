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
    corner.uu = glm::dot(u, u) + floor_;
    corner.uv = glm::dot(u, v) + 0.5 * floor_;
    corner.vv = glm::dot(v, v) + floor_;
    corner.area = 0.5 * std::sqrt(std::max(0.0, corner.uu * corner.vv - corner.uv * corner.uv));
  }
}

// Sum over the star, by the area on the surface, of (r + 1/r) (g + 1/g): r is the ratio of the
// singular values of the map between the flat triangles, g their product in proportion to the
// areas of the whole. Infinite where a triangle is not positive.
double StarRelaxation::distortion_at(const DVec3& point) const {
  double sum = 0;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Corner& corner = corners_[i];
    const DVec3 u = corner.place - point;
    const DVec3 v = corners_[i + 1 == corners_.size() ? 0 : i + 1].place - point;
    const DVec3 normal = glm::cross(u, v);
    if (!(glm::dot(normal, point) > 0)) return std::numeric_limits<double>::infinity();
    const double trace =
        glm::dot(v, v) * corner.uu - 2 * glm::dot(u, v) * corner.uv + glm::dot(u, u) * corner.vv;
    const double twice_area = std::sqrt(glm::dot(normal, normal));
    const double growth = 2 * corner.area / (twice_area * scale_);
    sum += trace / twice_area * (growth + 1 / growth);
  }
  return sum;
}

bool StarRelaxation::accept(std::uint32_t vertex, const DVec3& point) {
  const SpherePoint rounded = to_sphere_point(point);
  if (!is_star_positive(points_, mesh_.ring(vertex), rounded)) return false;
  points_[vertex] = rounded;
  return true;
}

double StarRelaxation::relax(std::uint32_t vertex, int rounds) {
  gather(vertex);
  const DVec3 start = direction(points_[vertex]);
  DVec3 best_point = start;
  double best = distortion_at(start);
  double nearest = 4;
  for (const Corner& corner : corners_)
    nearest = std::min(nearest, glm::distance(corner.place, start));
  double reach = 0.25 * nearest;
  for (int round = 0; round < rounds; ++round) {
    const auto [u, v] = tangent_frame(best_point);
    const DVec3 center = best_point;
    const double at_center = best;
    dvec2 jump(0);
    for (int axis = 0; axis < 2; ++axis) {
      const DVec3 way = reach * (axis == 0 ? u : v);
      const double ahead = distortion_at(center + way), behind = distortion_at(center - way);
      if (ahead < best) best = ahead, best_point = center + way;
      if (behind < best) best = behind, best_point = center - way;
      const double bend = ahead + behind - 2 * at_center;
      if (bend > 0 && std::isfinite(bend))
        jump[axis] = std::clamp(0.5 * (behind - ahead) / bend, -2.0, 2.0);
    }
    const DVec3 lowest = center + reach * (jump.x * u + jump.y * v);
    const double at_lowest = distortion_at(lowest);
    if (at_lowest < best) best = at_lowest, best_point = lowest;
    if (best < at_center) best_point = glm::normalize(best_point);
    reach *= best < at_center ? 0.7 : 0.25;
  }
  if (best_point == start || !accept(vertex, best_point)) return 0;
  return glm::distance(best_point, start);
}

bool StarRelaxation::place(std::uint32_t vertex) {
  if (!place_in_kernel(vertex) && !place_near_target(vertex)) return false;
  relax(vertex, 6);
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
