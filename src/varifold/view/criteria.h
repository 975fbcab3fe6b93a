// Where a surface needs detail: what the models with levels per region ask before they refine.
//
// Based on: [Hoppe1997] section 4 (frustum, orientation, screen-space error), section 8 (local
//   illumination); [Ramos2008] section 3.4.2 (silhouettes, a sphere and a plane of the user).
// Differs: every criterion judges a ball and a cone of normals, not a point; together they give one
//   number in pixels instead of a yes or no, so that a budget can be met by comparing numbers.
#pragma once

#include <varifold/view/camera.h>
#include <varifold/view/cone.h>
#include <varifold/view/frustum.h>
#include <varifold/view/sphere.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

namespace varifold {

/// What is known of a piece of surface that may be refined.
struct RegionBounds {
  Sphere ball;      ///< holds all that refining it changes, now and later; not empty
  NormalCone cone;  ///< of the normals in there
  float error = 0;  ///< how far the surface may be off while it is coarse, model units
};

/// Whether a ball reaches into another one, or to the side of a plane that its normal points to.
/// An empty place is reached by nothing.
[[nodiscard]] inline bool touches(const Sphere& place, const Sphere& ball) {
  return !place.empty() && distance_to(place, ball.center) <= ball.radius;
}
[[nodiscard]] inline bool touches(const Plane& side, const Sphere& ball) {
  return side.signed_distance(ball.center) >= -ball.radius;
}

[[nodiscard]] inline bool touches(const Box& box, const Sphere& ball) {
  const Vec3 away = glm::max(glm::max(box.lower - ball.center, ball.center - box.upper), Vec3(0));
  return !box.empty() && glm::dot(away, away) <= ball.radius * ball.radius;
}

/// Detail inside a box down to an error: for collisions, selections, tools.
struct BoxCriterion {
  Box box;
  float error = 0;  ///< model units; regions with greater ones are refined
  friend bool operator==(const BoxCriterion& a, const BoxCriterion& b) {
    return a.box.lower == b.box.lower && a.box.upper == b.box.upper && a.error == b.error;
  }
};

/// Any other question of the user. It must nest: where it asks for a region, it asks for all that
/// have a ball around that region's ball and no smaller error.
class RegionPredicate {
 public:
  virtual ~RegionPredicate() = default;
  [[nodiscard]] virtual bool asks(const Sphere& ball, float error) const = 0;
};

/// The region may be a part of the outline seen from `eye`: some of it may face the eye, and some
/// may not.
[[nodiscard]] inline bool may_be_silhouette(const RegionBounds& region, const Vec3& eye) {
  return facing(region.cone, region.ball, eye) == Facing::kMixed;
}

/// The least and the greatest cosine between `direction` (length 1) and the normals of a cone.
struct CosineRange {
  float low = -1, high = 1;
};
[[nodiscard]] inline CosineRange cosine_range(const NormalCone& cone, const Vec3& direction) {
  // With a the angle to the axis and w that of the cone: cos(a + w) and cos(a - w), cut at 180
  // degrees and at 0.
  const float cosine = std::clamp(glm::dot(cone.axis, direction), -1.0f, 1.0f);
  const float sine = std::sqrt(1 - cosine * cosine);
  CosineRange range;
  if (cosine > -cone.cosine) range.low = cosine * cone.cosine - sine * cone.sine;
  if (cosine < cone.cosine) range.high = cosine * cone.cosine + sine * cone.sine;
  return range;
}

/// A light far away, and how its shading asks for detail.
struct LightCriterion {
  Vec3 to_light{0, 0, 1};  ///< length 1
  float specular = 0.5f;   ///< weight of the highlight beside the diffuse part
  float shininess = 32;    ///< Blinn's exponent
  /// What remains of the error, in [0, 1], where the shading does not change at all.
  float least_weight = 0.25f;
};

/// By how much the shading of a region may change over its normals, seen from `eye`: the range of
/// the diffuse part plus that of the highlight, which is judged at the middle of the ball.
[[nodiscard]] inline float shading_change(const LightCriterion& light, const RegionBounds& region,
                                          const Vec3& eye) {
  const auto lit = [](float x) { return std::max(x, 0.0f); };
  const CosineRange diffuse = cosine_range(region.cone, light.to_light);
  const float change = lit(diffuse.high) - lit(diffuse.low);
  if (diffuse.high <= 0 || light.specular <= 0) return change;
  const Vec3 half = normalize_or_zero(normalize_or_zero(eye - region.ball.center) + light.to_light);
  const CosineRange gloss = cosine_range(region.cone, half);
  // Where no light falls there is no highlight either.
  const float dullest = diffuse.low <= 0 ? 0 : std::pow(lit(gloss.low), light.shininess);
  return change + light.specular * (std::pow(lit(gloss.high), light.shininess) - dullest);
}

/// How models whose bounds know in which direction a surface is off judge it (models/vdpm); others
/// take it as a length.
enum class DeviationMeasure : std::uint8_t {
  kSeen,    ///< what is seen of it from the eye
  kLength,  ///< all of it, whatever its direction
};

/// What a camera asks for: errors in pixels, more or less of them by where the region lies and how
/// it is turned. All weights are factors on the error in pixels; 0 means "as coarse as can be".
struct ViewCriterion {
  explicit ViewCriterion(const Camera& camera)
      : scale(camera), frustum(frustum_of(camera)), eye(camera.eye) {}

  PixelScale scale;
  Frustum frustum;
  Vec3 eye;
  float outside_weight = 0;     ///< wholly outside the frustum
  float back_weight = 0;        ///< wholly turned away
  float silhouette_weight = 1;  ///< neither wholly turned away nor wholly turned to the eye
  std::optional<LightCriterion> light;
  DeviationMeasure deviation = DeviationMeasure::kSeen;

  /// What urgency() is at most, whatever the normals and the light; cheap.
  [[nodiscard]] float bound(const Sphere& ball, float error) const {
    return scale.pixels_of(error, ball) * std::max(1.0f, outside_weight) *
           std::max({1.0f, back_weight, silhouette_weight});
  }
  /// Pixels; O(1).
  [[nodiscard]] float urgency(const RegionBounds& region) const {
    float pixels = scale.pixels_of(region.error, region.ball);
    if (pixels <= 0) return 0;
    const Facing turned = facing(region.cone, region.ball, eye);
    if (turned == Facing::kBack) pixels *= back_weight;
    if (turned == Facing::kMixed) pixels *= silhouette_weight;
    if (outside_weight != 1 && classify(frustum, region.ball) == Containment::kOutside)
      pixels *= outside_weight;
    if (light && pixels > 0) {
      const float change = std::min(1.0f, shading_change(*light, region, eye));
      pixels *= light->least_weight + (1 - light->least_weight) * change;
    }
    return pixels;
  }
};

/// All that asks for detail at a time. Without any part nothing does.
class RefineCriteria {
 public:
  std::optional<ViewCriterion> view;
  std::optional<Sphere> sphere;  ///< full detail in this ball
  std::optional<Plane> plane;    ///< full detail on the side that the normal points to
  std::span<const BoxCriterion> boxes;
  const RegionPredicate* predicate = nullptr;
  std::uint32_t predicate_version = 0;  ///< to be changed when the predicate's answers change

  /// Urgencies of full detail are above this, which no error in pixels reaches; those of greater
  /// errors are greater, for budgets.
  static constexpr float kFullDetail = 1e30f;

  /// A region is to be refined where this is above the tolerance in pixels. O(1), pure.
  [[nodiscard]] float urgency(const RegionBounds& region) const {
    return urgency(region.ball, region.error, 0, [&] { return region.cone; });
  }
  /// The same, or 0 where it is sure not to be above `least`; cone() is called only where normals
  /// matter.
  template <class ConeOf>
  [[nodiscard]] float urgency(const Sphere& ball, float error, float least,
                              const ConeOf& cone) const {
    if (is_placed_on(ball, error)) {
      const float size = error + ball.radius;
      return kFullDetail * (1.5f + (size > 0 ? error / size : 0.0f));
    }
    if (!view || view->bound(ball, error) <= least) return 0;
    return std::min(view->urgency({ball, cone(), error}), kFullDetail);
  }

  /// Whether sphere, plane, a box or the predicate asks for it, whatever the view.
  [[nodiscard]] bool is_placed_on(const Sphere& ball, float error) const {
    if ((sphere && touches(*sphere, ball)) || (plane && touches(*plane, ball))) return true;
    for (const BoxCriterion& box : boxes)
      if (error > box.error && touches(box.box, ball)) return true;
    return predicate != nullptr && predicate->asks(ball, error);
  }
};

}  // namespace varifold
