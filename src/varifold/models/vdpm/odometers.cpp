#include <varifold/models/vdpm/odometers.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace varifold {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t index_of(Mover mover) { return static_cast<std::size_t>(mover); }

// The distance from a point to the segment between two others.
double distance_to_segment(const DVec3& point, const DVec3& a, const DVec3& b) {
  const DVec3 ab = b - a;
  const double squared = glm::dot(ab, ab);
  const double along = squared > 0 ? std::clamp(glm::dot(point - a, ab) / squared, 0.0, 1.0) : 0;
  return glm::length(point - a - along * ab);
}

// How far the distance to any plane may have changed for a point in the mesh.
double plane_motion(const Frustum& from, const Frustum& to, const Sphere& mesh) {
  double greatest = 0;
  for (std::size_t i = 0; i < Frustum::kSideCount; ++i) {
    const Plane &a = from.planes[i], &b = to.planes[i];
    const double at_center =
        glm::dot(DVec3(b.normal) - DVec3(a.normal), DVec3(mesh.center)) + (b.offset - a.offset);
    const double turn = glm::length(DVec3(b.normal) - DVec3(a.normal));
    greatest = std::max(greatest, std::abs(at_center) + turn * static_cast<double>(mesh.radius));
  }
  return greatest;
}

}  // namespace

float Odometers::reach(const Vec3& eye, float near_distance) {
  const float farthest = glm::length(eye - mesh_.center) + std::max(mesh_.radius, 0.0f);
  present_reach_ = 2.01f * std::max(farthest, near_distance);
  reach_ = std::max(reach_, present_reach_);
  return reach_;
}

bool Odometers::advance(const ViewQuery& from, const ViewQuery& to) {
  const DVec3 a(from.eye()), b(to.eye()), center(mesh_.center);
  const double path = glm::length(b - a);
  const double radius = std::max(mesh_.radius, 0.0f);
  const double nearest = distance_to_segment(center, a, b);
  // The lines of sight to a point and to the centre differ by at most the angle of the radius.
  const double spread =
      nearest > radius ? 2 * std::sin(0.5 * std::asin(radius / nearest)) * path : 2 * path;
  const double away = glm::length(b - center) - glm::length(a - center);
  const double ratio = static_cast<double>(to.unit_distance()) / from.unit_distance();
  const double tolerance = ratio == 1 ? 0 : std::abs(std::log(ratio)) * reach_;
  const double planes =
      to.tests_frustum() ? plane_motion(from.frustum(), to.frustum(), mesh_) : 0.0;
  // No gap changes by more than the nearest distance that counts does.
  const double nearer = std::abs(static_cast<double>(to.numbers().nearest) -
                                 static_cast<double>(from.numbers().nearest));
  const double all = std::max(path, planes) + tolerance + nearer;
  if (all == 0) return false;
  const double lost = 1e-6 * (path + planes + tolerance + nearer);

  total_[index_of(Mover::kApproach)] += std::min(path, spread - away) + tolerance + lost;
  total_[index_of(Mover::kRecede)] +=
      std::max(std::min(path, spread + away) + tolerance, all / kRecedeShare) + lost;
  total_[index_of(Mover::kEye)] += path + tolerance + nearer + lost;
  total_[index_of(Mover::kPlanes)] += planes + lost;
  total_[index_of(Mover::kAll)] += all + lost;
  round();
  return true;
}

float Odometers::key(Mover mover, float slack) const {
  if (mover == Mover::kNothing)
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(kInfinity) - 8 +
                                static_cast<std::uint32_t>(mover));
  const float sum = base_[index_of(mover)] + slack;
  // Down by what the last three bits may add, and by rounding; keys are above 0.
  const auto bits = std::bit_cast<std::uint32_t>(std::max(sum, 1e-30f));
  return std::bit_cast<float>(((bits - 8u) & ~7u) | static_cast<std::uint32_t>(mover));
}

bool Odometers::is_worn() const {
  const double size = std::max(static_cast<double>(reach_), 1e-20);
  return std::any_of(total_.begin(), total_.begin() + index_of(Mover::kNothing),
                     [&](double total) { return !(total >= size && total <= 64 * size); });
}

void Odometers::rebase() {
  total_.fill(16 * std::max(static_cast<double>(reach_), 1e-20));
  total_[index_of(Mover::kNothing)] = 0;
  round();
}

void Odometers::round() {
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto nearest = static_cast<float>(total_[i]);
    now_[i] = std::nextafter(nearest, kInfinity);
    base_[i] = std::nextafter(nearest, -kInfinity);
  }
  now_[index_of(Mover::kNothing)] = 0;
}

}  // namespace varifold
