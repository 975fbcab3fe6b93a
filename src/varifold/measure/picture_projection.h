// Where points of the world are in a picture, in double precision.
#pragma once

#include <varifold/base/math.h>
#include <varifold/view/camera.h>
#include <cmath>

namespace varifold {

/// Points to pixels about the middle of the picture.
class PictureProjection {
 public:
  explicit PictureProjection(const Camera& camera)
      : eye_(camera.eye),
        forward_(view_direction(camera)),
        right_(glm::normalize(glm::cross(forward_, DVec3(camera.up)))),
        up_(glm::cross(right_, forward_)),
        focal_pixels_(PixelScale(camera).focal_pixels()),
        near_(camera.near_distance),
        half_width_(0.5 * camera.width),
        half_height_(0.5 * camera.height) {}

  struct Point {
    double x = 0, y = 0;
    bool is_in_front = false;  ///< beyond the near plane
  };
  [[nodiscard]] Point operator()(const DVec3& point) const {
    const DVec3 ray = point - eye_;
    const double depth = glm::dot(ray, forward_);
    if (!(depth >= near_)) return {};
    const double scale = focal_pixels_ / depth;
    return {scale * glm::dot(ray, right_), scale * glm::dot(ray, up_), true};
  }
  /// Whether a jump between these places shows.
  [[nodiscard]] bool shows(const DVec3& from, const DVec3& to) const {
    const Point a = (*this)(from), b = (*this)(to);
    return a.is_in_front && b.is_in_front && (is_in_picture(a) || is_in_picture(b));
  }
  /// Of places before the near plane.
  [[nodiscard]] float pixels(const DVec3& from, const DVec3& to) const {
    const Point a = (*this)(from), b = (*this)(to);
    return static_cast<float>(std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)));
  }

  [[nodiscard]] bool is_in_picture(const Point& p) const {
    return std::abs(p.x) <= half_width_ && std::abs(p.y) <= half_height_;
  }
  [[nodiscard]] const DVec3& eye() const { return eye_; }

 private:
  DVec3 eye_, forward_, right_, up_;
  double focal_pixels_, near_, half_width_, half_height_;
};

}  // namespace varifold
