#include <varifold/view/camera.h>

#include <varifold/base/angle.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

namespace varifold {
namespace {

/// far / near at most: with a 24-bit depth buffer this still resolves 1/800 of the far distance.
constexpr float kMaxDepthRatio = 20000;

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

float half_tangent(float fovy_degrees) {
  return static_cast<float>(half_angle_tangent(fovy_degrees));
}

/// A unit vector perpendicular to the unit vector `v`, near the z axis where that is possible.
Vec3 any_perpendicular(const Vec3& v) {
  const Vec3 seed = std::abs(v.z) < 0.9f ? Vec3(0, 0, 1) : Vec3(0, -1, 0);
  return glm::normalize(seed - v * glm::dot(seed, v));
}

/// The axes of a camera: right, true up, and back (towards the viewer).
struct Axes {
  Vec3 right, up, back;
};

Axes axes_of(const FrameOptions& options) {
  Vec3 up = normalize_or_zero(options.up);
  if (up == Vec3(0)) up = Vec3(0, 1, 0);
  const Vec3 front = any_perpendicular(up);
  const Vec3 side = glm::cross(up, front);
  const float azimuth = glm::radians(options.azimuth_degrees);
  // Straight above or below, `up` would no longer say which way is up in the picture.
  const float elevation = glm::radians(std::clamp(options.elevation_degrees, -89.5f, 89.5f));

  Axes axes;
  axes.back = std::cos(elevation) * (std::cos(azimuth) * front + std::sin(azimuth) * side) +
              std::sin(elevation) * up;
  axes.right = glm::normalize(glm::cross(up, axes.back));
  axes.up = glm::cross(axes.back, axes.right);
  return axes;
}

/// One direction across the picture: the extent of all points' shadows onto the near side along
/// the two lines of sight that bound the picture, x + t z and -x + t z.
struct Extent {
  float plus = std::numeric_limits<float>::lowest();
  float minus = std::numeric_limits<float>::lowest();

  void add(float across, float sheared_depth) {
    plus = std::max(plus, across + sheared_depth);
    minus = std::max(minus, -across + sheared_depth);
  }
  /// The eye must satisfy e + t z >= plus and -e + t z >= minus; both are equalities here.
  [[nodiscard]] float eye_across() const { return 0.5f * (plus - minus); }
  [[nodiscard]] float eye_depth(float tangent) const { return 0.5f * (plus + minus) / tangent; }
};

}  // namespace

bool is_usable(const Camera& camera) {
  const bool finite = is_finite(camera.eye) && is_finite(camera.target) && is_finite(camera.up) &&
                      std::isfinite(camera.far_distance);
  if (!finite) return false;
  const bool lens = camera.fovy_degrees > 0 && camera.fovy_degrees < 180 && camera.width > 0 &&
                    camera.height > 0 && camera.near_distance > 0 &&
                    camera.near_distance < camera.far_distance;
  const Vec3 direction = normalize_or_zero(camera.target - camera.eye);
  const Vec3 right = glm::cross(direction, normalize_or_zero(camera.up));
  return lens && glm::length(right) > 1e-6f;
}

Vec3 view_direction(const Camera& camera) { return glm::normalize(camera.target - camera.eye); }

Mat4 view_matrix(const Camera& camera) {
  return glm::lookAtRH(camera.eye, camera.target, camera.up);
}

Mat4 projection_matrix(const Camera& camera) {
  return glm::perspectiveRH_NO(glm::radians(camera.fovy_degrees), camera.aspect(),
                               camera.near_distance, camera.far_distance);
}

Mat4 view_projection_matrix(const Camera& camera) {
  return projection_matrix(camera) * view_matrix(camera);
}

void set_depth_range(Camera& camera, const Sphere& scene) {
  if (scene.empty()) return;
  const float depth = glm::dot(scene.center - camera.eye, view_direction(camera));
  // A little slack, so that rounding does not cut the nearest and the farthest point.
  const float slack = 1e-3f * (scene.radius + std::abs(depth)) + 1e-20f;
  camera.far_distance = depth + scene.radius + slack;
  if (camera.far_distance <= 0) camera.far_distance = scene.radius + slack;  // all is behind
  camera.near_distance =
      std::max(depth - scene.radius - slack, camera.far_distance / kMaxDepthRatio);
}

Camera frame(std::span<const Vec3> points, const FrameOptions& options) {
  Camera camera;
  camera.width = options.width;
  camera.height = options.height;
  camera.fovy_degrees = options.fovy_degrees;
  camera.up = normalize_or_zero(options.up) == Vec3(0) ? Vec3(0, 1, 0) : options.up;
  const Axes axes = axes_of(options);
  Box box;
  for (const Vec3& p : points) box.add(p);
  const Vec3 center = box.center();

  // Measure about the centre, so that large coordinates lose nothing.
  const float free = 1 - std::clamp(options.margin, 0.0f, 0.9f);
  const float tangent_y = half_tangent(options.fovy_degrees) * free;
  const float tangent_x = tangent_y * camera.aspect();
  Extent x, y;
  float nearest = 0, farthest = 0;
  for (const Vec3& p : points) {
    const Vec3 q = p - center;
    const float z = glm::dot(q, axes.back);
    x.add(glm::dot(q, axes.right), tangent_x * z);
    y.add(glm::dot(q, axes.up), tangent_y * z);
    nearest = std::max(nearest, z);
    farthest = std::min(farthest, z);
  }
  if (points.empty()) x.plus = x.minus = tangent_x, y.plus = y.minus = tangent_y;

  // Put the eye where the tighter of the two directions just fits.
  float depth = std::max(x.eye_depth(tangent_x), y.eye_depth(tangent_y));
  // Not nearer than float can tell the eye from the points.
  const float far_off = glm::length(center);
  const float size =
      box.diagonal() > 0 ? std::max(box.diagonal(), 1e-5f * far_off) : std::max(20.0f, far_off);
  depth = std::max(depth, nearest + 0.05f * size);
  camera.eye = center + x.eye_across() * axes.right + y.eye_across() * axes.up + depth * axes.back;
  camera.target = camera.eye - depth * axes.back;
  const float half_depth = 0.5f * (nearest - farthest);
  const Vec3 middle = center + 0.5f * (nearest + farthest) * axes.back;
  set_depth_range(camera, {middle, std::max(half_depth, 0.01f * depth)});
  return camera;
}

Camera frame(const Box& box, const FrameOptions& options) {
  if (box.empty()) return frame(std::span<const Vec3>{}, options);
  std::array<Vec3, 8> corners;
  for (int i = 0; i < 8; ++i)
    corners[i] = Vec3(i & 1 ? box.upper.x : box.lower.x, i & 2 ? box.upper.y : box.lower.y,
                      i & 4 ? box.upper.z : box.lower.z);
  return frame(corners, options);
}

PixelScale::PixelScale(const Camera& camera)
    : eye_(camera.eye),
      near_distance_(camera.near_distance),
      focal_pixels_(0.5f * static_cast<float>(camera.height) / half_tangent(camera.fovy_degrees)) {}

float pixels_of(const Camera& camera, float error, const Vec3& point) {
  return PixelScale(camera).pixels_of(error, point);
}

float pixel_size(const Camera& camera, float distance) {
  return PixelScale(camera).pixel_size(distance);
}

}  // namespace varifold
