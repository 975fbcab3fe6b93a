// Turns one map onto the sphere so that it meets another one where the shapes are alike.
#pragma once

#include <varifold/morph/sphere_triangulation.h>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace varifold {

/// Vertices of two surfaces that shall meet.
using FeaturePoint = std::pair<std::uint32_t, std::uint32_t>;

/// Three rows of a rotation.
using Rotation = std::array<DVec3, 3>;

[[nodiscard]] inline DVec3 rotated(const Rotation& rotation, const DVec3& v) {
  return {glm::dot(rotation[0], v), glm::dot(rotation[1], v), glm::dot(rotation[2], v)};
}

inline constexpr Rotation kNoRotation{DVec3(1, 0, 0), DVec3(0, 1, 0), DVec3(0, 0, 1)};

/// How the second of two shapes is best turned towards the first one.
struct ShapeAlignment {
  Rotation sphere;  ///< of its map
  Rotation shape;   ///< of itself, about its middle: takes axes to axes
};

/// A surface by its points and where they lie on the sphere.
struct SphereMap {
  const SphereTriangulation& sphere;
  std::span<const Vec3> positions;  ///< one for each of sphere.points
};

/// The 24 rotations that take axes to axes; the identity first.
[[nodiscard]] std::vector<Rotation> axis_rotations();

/// The rotation of the sphere of `b` that brings each pair of features (points of a, of b) closest
/// together, least squares. Some thousand rotations are tried and the best ones refined.
[[nodiscard]] Rotation align_features(const SphereMap& a, const SphereMap& b,
                                      std::span<const FeaturePoint> features);

/// The rotation of the sphere of `b` under which places of the shapes that meet are closest, least
/// squares over the sphere; shapes are compared with the middles of their surfaces together and at
/// one size. They should stand alike; but if one of them turned by a multiple of 90 degrees about
/// axes lies clearly nearer to the other, it is compared so. O(n + 5 million look-ups), the same
/// result always.
[[nodiscard]] ShapeAlignment align_shapes(const SphereMap& a, const SphereMap& b);

/// The rotation by multiples of 90 degrees that brings the second places closest to the first ones
/// they meet, both about their middles; none unless another one is clearly better.
[[nodiscard]] Rotation best_axis_turn(std::span<const Vec3> places, std::span<const Vec3> others);

/// All directions turned; rounded, so triangles of less than 1e-11 in height may turn over.
[[nodiscard]] std::vector<SpherePoint> rotated_points(std::span<const SpherePoint> points,
                                                      const Rotation& rotation);

}  // namespace varifold
