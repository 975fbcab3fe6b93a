// The questions of a frame, and how far the eye may travel before an answer can change.
//
// Based on: [Hoppe1997] section 4 (frustum, orientation, screen-space error with its deviation
//   space).
// Differs: every criterion judges a ball, not a point; each is a distance g, 1-Lipschitz in the eye
//   and below 0 where it asks for detail, so that |g| says how far the eye may go until the answer
//   changes. The deviation space needs no approximation for this: the eyes that see delta above
//   the tolerance fill a torus around the normal.
#pragma once

#include <varifold/base/math.h>
#include <varifold/view/cone.h>
#include <varifold/view/criteria.h>
#include <varifold/view/frustum.h>
#include <varifold/view/sphere.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace varifold {

/// What an answer depends on; each has an odometer (odometers.h).
enum class Mover : std::int32_t {
  kApproach,  ///< the eye coming nearer, or the tolerance falling
  kRecede,    ///< the eye going away, or the tolerance rising; and a little of kAll
  kEye,       ///< the eye going anywhere, or the tolerance changing
  kPlanes,    ///< the planes of the frustum
  kAll,       ///< any of them
  kNothing,   ///< only other criteria
  kCount
};

/// The odometer of kRecede goes at least a fourth as fast as that of kAll.
inline constexpr float kRecedeShare = 4;

/// An answer, and for how much motion of `mover` it stays the same.
struct ViewAnswer {
  bool asked = false;
  Mover mover = Mover::kNothing;
  float slack = 0;  ///< model units; at least 0
};

/// What a test knows of a region: a ball, a cone about `axis`, and a deviation space: `mu` in all
/// directions, `delta` along the axis.
struct ViewRegion {
  Vec3 center;
  float radius;
  NormalCone cone;  ///< sine and cosine of its angle; wide: tells nothing
  float mu, delta;
};

namespace view_query {

inline constexpr float kFar = 1e30f;

// std::max and std::min take references, which keeps loops from becoming vector code.
[[nodiscard]] constexpr float greater(float a, float b) { return a > b ? a : b; }
[[nodiscard]] constexpr float smaller(float a, float b) { return a < b ? a : b; }

[[nodiscard]] constexpr std::int32_t number_of(Mover mover) {
  return static_cast<std::int32_t>(mover);
}

/// A view as plain numbers.
struct Numbers {
  float eye_x = 0, eye_y = 0, eye_z = 0;
  float unit_distance = 0, nearest = 0, reach = 0;
  float as_seen = 1;  // 0: deviations are lengths, so that delta is a mu
  std::int32_t tests_frustum = 0, tests_facing = 0;
  float planes[Frustum::kSideCount][4] = {};
};

/// A region and its answer as plain numbers, so that loops over them become vector code.
struct Lane {
  float x, y, z, radius;
  float axis_x, axis_y, axis_z, cosine, sine;
  float mu, delta, keep;
};
struct LaneAnswer {
  float slack;
  std::int32_t asked, mover;
};

/// The distance from an eye so far `aside` of the axis to the solid torus in which
/// delta * sin(angle to the axis) * unit_distance is above the distance; `size` = delta *
/// unit_distance is the diameter of its section, which touches the axis. Below 0 inside.
[[nodiscard]] inline float distance_to_torus(float aside, float distance_squared, float size) {
  // sqrt((aside - size/2)^2 + along^2) - size/2, without the difference of great numbers.
  const float half = 0.5f * size, beyond = distance_squared - aside * size;
  return beyond / (std::sqrt(greater(beyond + half * half, 0)) + half + 1e-30f);
}

/// ViewQuery::test() of a lane: no branches.
[[nodiscard]] inline LaneAnswer test_lane(const Numbers& view, const Lane& region) {
  const float px = view.eye_x - region.x, py = view.eye_y - region.y, pz = view.eye_z - region.z;
  const float squared = px * px + py * py + pz * pz;
  const float distance = std::sqrt(squared);
  const float along = px * region.axis_x + py * region.axis_y + pz * region.axis_z;
  const float aside = std::sqrt(greater(squared - along * along, 0));
  const float margin = region.keep * distance;

  // The error: the eye is inside the ball around the region from which mu is too large, or in the
  // torus from which delta is.
  const float mu = greater(region.mu, region.delta * (1 - view.as_seen));
  const float delta = region.delta * view.as_seen;
  const float mu_size = smaller(mu * view.unit_distance, view.reach);
  const float delta_size = delta * view.unit_distance;
  const float gap = greater(distance - region.radius, view.nearest);
  const float mu_gap = gap - mu_size - margin;
  const float torus = distance_to_torus(aside, squared, delta_size) - region.radius;
  const float delta_gap = greater(torus, view.nearest - delta_size) - margin;
  const bool is_directed = delta > mu;
  const float error_gap = is_directed ? smaller(mu_gap, delta_gap) : mu_gap;
  // Without regard to the direction, which makes for slack that depends on the distance alone.
  const float round_gap = is_directed ? gap - smaller(delta_size, view.reach) - margin : mu_gap;

  float outside = -kFar;
  for (const float* plane : {view.planes[0], view.planes[1], view.planes[2], view.planes[3],
                             view.planes[4], view.planes[5]}) {
    const float inside = plane[0] * region.x + plane[1] * region.y + plane[2] * region.z + plane[3];
    outside = greater(outside, -inside);
  }
  const float plane_gap = view.tests_frustum != 0 ? outside - region.radius - margin : -kFar;
  // Turned away for certain: the greatest product of a normal of the cone with p, plus the radius,
  // is below 0.
  const float turned = -(along * region.cosine + aside * region.sine) - region.radius - margin;
  const float facing_gap = view.tests_facing != 0 && region.cosine > 0 ? turned : -kFar;

  // Asked: any of them may come to say no. Of the odometer of kRecede only the distance may take
  // all; it goes at least a part as fast as that of kAll, for the others and for what is nearer
  // than nearest.
  const float others = -greater(plane_gap, facing_gap);
  const float until_no_any = smaller(-error_gap, others);
  const float until_no_far =
      smaller(-mu_gap, smaller(others, mu_size - view.nearest) / kRecedeShare);
  const bool by_distance = until_no_far >= 0.5f * until_no_any;
  const float until_no = by_distance ? until_no_far : until_no_any;
  // Not asked: one that says no is enough; the one that will say so for longest.
  const bool is_far = distance - region.radius >= view.nearest;
  const bool by_round = is_far & (round_gap >= 0.5f * error_gap);
  const bool by_facing = facing_gap > error_gap;
  const bool by_planes = plane_gap > greater(error_gap, facing_gap);
  const float by_error = by_round ? round_gap : error_gap;
  const float by_other = by_facing ? facing_gap : by_error;
  const float until_yes = by_planes ? plane_gap : by_other;

  const bool asked = greater(error_gap, greater(plane_gap, facing_gap)) < 0;
  const std::int32_t any =
      view.tests_frustum != 0 ? number_of(Mover::kAll) : number_of(Mover::kEye);
  const std::int32_t yes = by_distance ? number_of(Mover::kRecede) : any;
  const std::int32_t near = by_round ? number_of(Mover::kApproach) : number_of(Mover::kEye);
  const std::int32_t no_planes = by_facing ? number_of(Mover::kEye) : near;
  const std::int32_t no = by_planes ? number_of(Mover::kPlanes) : no_planes;
  // What floats may lose on the way to the gaps.
  const float lost = 1e-5f * (distance + region.radius + mu_size);
  return {greater(((asked ? until_no : until_yes) - lost) / (1 + region.keep), 0), asked ? 1 : 0,
          asked ? yes : no};
}

}  // namespace view_query

/// A view, made ready for many tests. Made once a frame; plain data.
class ViewQuery {
 public:
  ViewQuery() = default;
  /// `tolerance` in pixels; `reach` bounds the distances from the eye that matter (odometers.h).
  ViewQuery(const ViewCriterion& view, float tolerance, float reach) : frustum_(view.frustum) {
    numbers_.eye_x = view.eye.x;
    numbers_.eye_y = view.eye.y;
    numbers_.eye_z = view.eye.z;
    numbers_.unit_distance =
        std::min(view.scale.focal_pixels() / std::max(tolerance, 1e-12f), 1e12f);
    numbers_.nearest = view.scale.near_distance();
    numbers_.reach = reach;
    numbers_.as_seen = view.deviation == DeviationMeasure::kSeen ? 1 : 0;
    numbers_.tests_frustum = view.outside_weight < 1 ? 1 : 0;
    numbers_.tests_facing = view.back_weight < 1 ? 1 : 0;
    for (std::size_t i = 0; i < Frustum::kSideCount; ++i) {
      const Plane& plane = frustum_.planes[i];
      const std::array<float, 4> numbers{plane.normal.x, plane.normal.y, plane.normal.z,
                                         plane.offset};
      std::copy(numbers.begin(), numbers.end(), numbers_.planes[i]);
    }
  }

  [[nodiscard]] Vec3 eye() const { return {numbers_.eye_x, numbers_.eye_y, numbers_.eye_z}; }
  [[nodiscard]] const Frustum& frustum() const { return frustum_; }
  /// The distance from which a length of one unit is seen under the tolerance.
  [[nodiscard]] float unit_distance() const { return numbers_.unit_distance; }
  [[nodiscard]] bool tests_frustum() const { return numbers_.tests_frustum != 0; }
  [[nodiscard]] const view_query::Numbers& numbers() const { return numbers_; }

  /// False where the region is outside the frustum or turned away for certain. O(1).
  [[nodiscard]] bool may_see(const ViewRegion& region) const {
    const Sphere ball{region.center, region.radius};
    if (tests_frustum() && classify(frustum_, ball) == Containment::kOutside) return false;
    return numbers_.tests_facing == 0 || !is_back_facing(region.cone, ball, eye());
  }
  /// Whether the region asks for detail; with `keep` > 0 also where it would after the eye moved by
  /// that part of its distance. O(1).
  [[nodiscard]] ViewAnswer test(const ViewRegion& region, float keep = 0) const {
    const NormalCone& cone = region.cone;
    const view_query::LaneAnswer answer =
        view_query::test_lane(numbers_, {region.center.x, region.center.y, region.center.z,
                                         region.radius, cone.axis.x, cone.axis.y, cone.axis.z,
                                         cone.cosine, cone.sine, region.mu, region.delta, keep});
    return {answer.asked != 0, static_cast<Mover>(answer.mover), answer.slack};
  }

 private:
  view_query::Numbers numbers_;
  Frustum frustum_;
};

}  // namespace varifold
