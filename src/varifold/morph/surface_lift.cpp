#include <varifold/morph/surface_lift.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace varifold {
namespace {

constexpr double kRounding = 1e-9;

}  // namespace

double area_of(std::span<const std::uint32_t> indices, std::span<const Vec3> positions) {
  double area = 0;
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    const DVec3 a(positions[indices[t]]), b(positions[indices[t + 1]]),
        c(positions[indices[t + 2]]);
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return area;
}

SurfaceLift::SurfaceLift(const SphereTriangulation& sphere, std::span<const Vec3> positions)
    : sphere_(sphere), positions_(positions), area_(area_of(sphere.indices, positions)) {
  directions_.reserve(sphere.points.size());
  for (const SpherePoint& point : sphere.points) directions_.push_back(direction(point));
}

// A walk over the edge that the point is farthest outside of. Rounding may end it in the triangle
// beside the right one, or, where triangles are as small as that, send it in circles.
DVec3 SurfaceLift::at(const DVec3& point, std::uint32_t& triangle) const {
  const auto most_steps = static_cast<std::uint32_t>(sphere_.indices.size() / 3 + 8);
  for (std::uint32_t step = 0; step < most_steps; ++step) {
    const std::uint32_t first = 3 * triangle;
    const std::array<std::uint32_t, 3> corners{sphere_.indices[first], sphere_.indices[first + 1],
                                               sphere_.indices[first + 2]};
    std::array<DVec3, 3> ways;
    for (std::size_t k = 0; k < 3; ++k) ways[k] = directions_[corners[k]] - point;
    std::array<double, 3> weights;  // of the corners; all negative at the antipode
    std::size_t least = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      weights[k] = glm::dot(glm::cross(ways[(k + 1) % 3], ways[(k + 2) % 3]), point);
      if (weights[k] < weights[least]) least = k;
    }
    const double sum = weights[0] + weights[1] + weights[2];
    if (weights[least] >= -kRounding * std::abs(sum)) {
      DVec3 place(0);
      for (std::size_t k = 0; k < 3; ++k)
        place +=
            (sum > 0 ? std::max(weights[k], 0.0) / sum : 1 / 3.0) * DVec3(positions_[corners[k]]);
      return place;
    }
    const std::uint32_t exit = first + static_cast<std::uint32_t>((least + 1) % 3);
    triangle = sphere_.opposite[exit] / 3;
  }
  return DVec3(positions_[sphere_.indices[3 * triangle]]);
}

}  // namespace varifold
