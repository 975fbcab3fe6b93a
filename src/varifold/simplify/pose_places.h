// The places of points: at rest, or in another pose.
#pragma once

#include <varifold/simplify/working_surface.h>
#include <cstddef>
#include <cstdint>

namespace varifold {

/// Those of the surface itself.
struct RestPlaces {
  static constexpr bool kIsRest = true;
  const PointState* points;
  explicit RestPlaces(const WorkingSurface& surface) : points(surface.points.data()) {}
  [[nodiscard]] const Vec3& position(std::uint32_t point) const { return points[point].position; }
  [[nodiscard]] std::uint32_t normal(std::uint32_t point) const { return points[point].normal; }
};

/// A point in another pose, in the units of the surface.
struct PosePlace {
  Vec3 position{0};
  std::uint32_t normal = 0;  ///< packed, as PointState::normal
};

/// Those of one pose; a point's places in all poses lie side by side.
struct PosePlaces {
  static constexpr bool kIsRest = false;
  const PosePlace* first;  ///< of point 0
  std::size_t stride;      ///< poses
  [[nodiscard]] const Vec3& position(std::uint32_t point) const {
    return first[point * stride].position;
  }
  [[nodiscard]] std::uint32_t normal(std::uint32_t point) const {
    return first[point * stride].normal;
  }
};

}  // namespace varifold
