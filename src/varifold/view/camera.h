// The pinhole camera, and the one place where lengths in model units become pixels.
#pragma once

#include <varifold/base/math.h>
#include <varifold/view/sphere.h>
#include <glm/mat4x4.hpp>
#include <span>

namespace varifold {

using Mat4 = glm::mat4;

/// A pinhole camera with square pixels. Right-handed; it looks along its negative z axis.
///
/// A camera is usable when eye and target differ, `up` is not parallel to the line of sight,
/// 0 < fovy_degrees < 180, the size is positive and 0 < near_distance < far_distance.
struct Camera {
  Vec3 eye{0, 0, 3};
  Vec3 target{0, 0, 0};
  Vec3 up{0, 1, 0};            ///< any length; need not be perpendicular to the line of sight
  float fovy_degrees = 35;     ///< the whole vertical angle of view
  int width = 1280;            ///< pixels
  int height = 960;            ///< pixels
  float near_distance = 0.1f;  ///< along the line of sight, model units
  float far_distance = 100;

  [[nodiscard]] float aspect() const {
    return static_cast<float>(width) / static_cast<float>(height);
  }
};

/// True when the camera satisfies what Camera asks for and all its numbers are finite.
[[nodiscard]] bool is_usable(const Camera& camera);

/// Unit vector from the eye to the target.
[[nodiscard]] Vec3 view_direction(const Camera& camera);

/// World to eye space.
[[nodiscard]] Mat4 view_matrix(const Camera& camera);

/// Eye to clip space; the OpenGL convention, depths -1 (near) to 1 (far) after the division.
[[nodiscard]] Mat4 projection_matrix(const Camera& camera);

/// projection_matrix * view_matrix.
[[nodiscard]] Mat4 view_projection_matrix(const Camera& camera);

/// Sets the near and far distance so that `scene` lies between them where it is in front of the
/// eye. near >= far / 20000, which keeps depth buffers sound when the eye is inside the scene.
void set_depth_range(Camera& camera, const Sphere& scene);

/// How `frame` looks at a mesh.
struct FrameOptions {
  int width = 1280;
  int height = 960;
  float fovy_degrees = 30;
  Vec3 up{0, 1, 0};
  /// Turns around `up` and above the horizon, degrees. 0, 0 looks at the +z side (for up = y).
  float azimuth_degrees = 30;
  float elevation_degrees = 20;
  float margin = 0.06f;  ///< part of the picture's half size that stays free on every side
};

/// The closest camera of that direction that sees all points inside the margins, with the depth
/// range set. Exact in the four sides of the picture; O(points). No points: a view of the origin.
[[nodiscard]] Camera frame(std::span<const Vec3> points, const FrameOptions& options = {});

/// The same for the corners of a box, where the points are not at hand.
[[nodiscard]] Camera frame(const Box& box, const FrameOptions& options = {});

/// Converts errors (model units) to pixels and back. Cheap to copy; made once per frame.
///
/// A length is projected as if it lay across the ray from the eye: this is what it measures in the
/// middle of the picture and does not change when the camera turns on the spot. Towards a corner
/// of the picture a flat projection stretches lengths by up to 1 / cos^2 of the angle off axis.
class PixelScale {
 public:
  explicit PixelScale(const Camera& camera);

  /// Pixels that a length of one unit covers at distance one.
  [[nodiscard]] float focal_pixels() const { return focal_pixels_; }
  /// Where everything is that is nearer.
  [[nodiscard]] float near_distance() const { return near_distance_; }
  /// Size of a pixel, in model units, at a distance from the eye.
  [[nodiscard]] float pixel_size(float distance) const { return clamped(distance) / focal_pixels_; }
  /// Pixels covered by the length `error` at a point.
  [[nodiscard]] float pixels_of(float error, const Vec3& point) const {
    return error * focal_pixels_ / clamped(glm::length(point - eye_));
  }
  /// The same at that point of a ball where it covers the most.
  [[nodiscard]] float pixels_of(float error, const Sphere& ball) const {
    return error * focal_pixels_ / clamped(distance_to(ball, eye_));
  }
  /// The length that covers `pixels` at a point: the inverse of pixels_of.
  [[nodiscard]] float error_of(float pixels, const Vec3& point) const {
    return pixels * pixel_size(glm::length(point - eye_));
  }
  [[nodiscard]] const Vec3& eye() const { return eye_; }

 private:
  /// Nothing nearer than the near plane is seen; this also keeps the divisions finite.
  [[nodiscard]] float clamped(float distance) const {
    return distance > near_distance_ ? distance : near_distance_;
  }

  Vec3 eye_;
  float near_distance_;
  float focal_pixels_;
};

/// One-off forms of the above.
[[nodiscard]] float pixels_of(const Camera& camera, float error, const Vec3& point);
[[nodiscard]] float pixel_size(const Camera& camera, float distance);

}  // namespace varifold
