#include <gtest/gtest.h>

#include <tests/view/random_points.h>
#include <varifold/view/cone_code.h>
#include <varifold/view/criteria.h>
#include <algorithm>
#include <cmath>
#include <vector>

namespace varifold {
namespace {

using test::point_in_ball;
using test::point_in_cube;
using test::uniform;
using test::unit_vector;

NormalCone random_cone(Random& random) {
  const float angle = uniform(random, 0, 3.1415926f);
  return {unit_vector(random), std::cos(angle), std::sin(angle)};
}

// A unit vector inside of a cone, often on its rim.
Vec3 normal_in(const NormalCone& cone, Random& random) {
  const float angle = std::acos(std::clamp(cone.cosine, -1.0f, 1.0f));
  const float part = random.below(2) == 0 ? 1.0f : uniform(random, 0, 1);
  Vec3 across = glm::cross(cone.axis, unit_vector(random));
  across = glm::normalize(across);
  return std::cos(part * angle) * cone.axis + std::sin(part * angle) * across;
}

TEST(ConeCode, HoldsTheCone) {
  Random random(1);
  for (int i = 0; i < 50000; ++i) {
    NormalCone cone = random_cone(random);
    if (i % 4 == 0) cone = {cone.axis, 1, 0};
    if (i % 4 == 1) {
      const float angle = uniform(random, 0, 0.05f);
      cone = {cone.axis, std::cos(angle), std::sin(angle)};
    }
    const NormalCone packed = unpack_cone(pack_cone(cone));
    EXPECT_NEAR(glm::length(packed.axis), 1, 1e-6);
    EXPECT_NEAR(packed.sine * packed.sine + packed.cosine * packed.cosine, 1, 1e-5);
    // The outermost normals of the cone, in double: none may lie outside.
    const double angle = std::acos(static_cast<double>(cone.cosine));
    const double kept = std::acos(static_cast<double>(packed.cosine));
    const glm::dvec3 a(cone.axis), b(packed.axis);
    const double turn = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    EXPECT_LE(std::min(angle + turn, 3.14159265), kept + 1e-4);
    // Near 180 degrees the steps are long.
    EXPECT_LT(kept - angle, angle < 1.6 ? 0.006 : 0.1);
  }
}

TEST(ConeCode, AnyCodeIsACone) {
  Random random(2);
  for (int i = 0; i < 100000; ++i) {
    const NormalCone cone = unpack_cone(static_cast<std::uint32_t>(random.next()));
    EXPECT_NEAR(glm::length(cone.axis), 1, 1e-5);
    EXPECT_GE(cone.cosine, -1);
    EXPECT_LE(cone.cosine, 1);
  }
  EXPECT_EQ(unpack_cone(kWideConeCode).cosine, -1);
  EXPECT_EQ(pack_cone(NormalCone{}), kWideConeCode);
}

TEST(Criteria, CosineRangeHoldsAllNormals) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const NormalCone cone = random_cone(random);
    const Vec3 direction = unit_vector(random);
    const CosineRange range = cosine_range(cone, direction);
    EXPECT_LE(range.low, range.high + 1e-6f);
    float low = 1, high = -1;
    for (int j = 0; j < 20; ++j) {
      const float cosine = glm::dot(normal_in(cone, random), direction);
      low = std::min(low, cosine);
      high = std::max(high, cosine);
    }
    EXPECT_GE(low, range.low - 1e-4f);
    EXPECT_LE(high, range.high + 1e-4f);
  }
  // Tight: the direction and its opposite are reached where they are inside.
  const NormalCone narrow{{0, 0, 1}, std::cos(0.5f), std::sin(0.5f)};
  EXPECT_EQ(cosine_range(narrow, {0, 0, 1}).high, 1);
  EXPECT_NEAR(cosine_range(narrow, {0, 0, 1}).low, std::cos(0.5f), 1e-6);
  EXPECT_NEAR(cosine_range(narrow, {1, 0, 0}).high, std::sin(0.5f), 1e-6);
  EXPECT_EQ(cosine_range(narrow, {0, 0, -1}).low, -1);
}

TEST(Criteria, PlacesOfTheUser) {
  Random random(4);
  int touched = 0;
  for (int i = 0; i < 20000; ++i) {
    RegionBounds region;
    region.ball = {point_in_cube(random, 1), uniform(random, 0, 0.5f)};
    region.error = uniform(random, 0, 0.1f);
    RefineCriteria criteria;
    criteria.sphere = Sphere{point_in_cube(random, 1), uniform(random, 0, 0.5f)};
    const bool asked = criteria.urgency(region) > RefineCriteria::kFullDetail;
    // A point of the region in the sphere: it must have been asked for.
    const Vec3 p = region.ball.center + region.ball.radius * point_in_ball(random);
    if (glm::length(p - criteria.sphere->center) < criteria.sphere->radius) {
      EXPECT_TRUE(asked);
      ++touched;
    }
    if (!asked) {
      EXPECT_EQ(criteria.urgency(region), 0);
    }
    criteria.sphere.reset();
    criteria.plane = Plane{unit_vector(random), uniform(random, -1, 1)};
    if (criteria.plane->signed_distance(p) > 0) {
      EXPECT_GT(criteria.urgency(region), RefineCriteria::kFullDetail);
    } else if (criteria.urgency(region) == 0) {
      EXPECT_LT(criteria.plane->signed_distance(region.ball.center), 0);
    }
  }
  EXPECT_GT(touched, 100);
  RefineCriteria nothing;
  EXPECT_EQ(nothing.urgency({{{0, 0, 0}, 1}, {}, 1}), 0);
  nothing.sphere = Sphere{};  // an empty one
  EXPECT_EQ(nothing.urgency({{{0, 0, 0}, 1}, {}, 1}), 0);
}

Camera front_camera() {
  Camera camera;
  camera.eye = {0, 0, 5};
  camera.fovy_degrees = 40;
  return camera;
}

TEST(Criteria, ViewByPlaceAndTurn) {
  const Camera camera = front_camera();
  ViewCriterion view(camera);
  const NormalCone to_eye{{0, 0, 1}, 0.99f, std::sqrt(1 - 0.99f * 0.99f)};
  const NormalCone away{{0, 0, -1}, 0.99f, std::sqrt(1 - 0.99f * 0.99f)};
  const RegionBounds seen{{{0, 0, 0}, 0.1f}, to_eye, 0.01f};
  EXPECT_FLOAT_EQ(view.urgency(seen), PixelScale(camera).pixels_of(0.01f, seen.ball));
  const RegionBounds farther{{{0, 0, -20}, 0.1f}, to_eye, 0.01f};
  EXPECT_LT(view.urgency(farther), view.urgency(seen));
  EXPECT_GT(view.urgency(farther), 0);
  const RegionBounds hidden{{{0, 0, 0}, 0.1f}, away, 0.01f};
  EXPECT_EQ(view.urgency(hidden), 0);
  view.back_weight = 0.5f;
  EXPECT_FLOAT_EQ(view.urgency(hidden), 0.5f * view.urgency(seen));
  const RegionBounds outside{{{9, 0, 0}, 0.1f}, NormalCone{}, 0.01f};
  EXPECT_EQ(view.urgency(outside), 0);
  // Partly outside is inside.
  EXPECT_GT(view.urgency({{{9, 0, 0}, 9}, NormalCone{}, 0.01f}), 0);
  const RegionBounds outline{{{0, 0, 0}, 0.1f}, NormalCone{}, 0.01f};
  EXPECT_TRUE(may_be_silhouette(outline, camera.eye));
  EXPECT_FALSE(may_be_silhouette(seen, camera.eye));
  EXPECT_FALSE(may_be_silhouette(hidden, camera.eye));
  view.silhouette_weight = 3;
  EXPECT_FLOAT_EQ(view.urgency(outline), 3 * view.urgency(seen));
  RefineCriteria both;
  both.view = view;
  both.sphere = Sphere{{9, 0, 0}, 1};
  EXPECT_GT(both.urgency(outside), RefineCriteria::kFullDetail);
  EXPECT_FLOAT_EQ(both.urgency(seen), view.urgency(seen));
}

// The change that is claimed is not below that between any two normals of the cone.
TEST(Criteria, ShadingChangeBoundsTheShading) {
  Random random(5);
  const auto shade = [](const LightCriterion& light, const Vec3& n, const Vec3& half) {
    const float diffuse = std::max(0.0f, glm::dot(n, light.to_light));
    if (diffuse <= 0) return 0.0f;
    return diffuse + light.specular * std::pow(std::max(0.0f, glm::dot(n, half)), light.shininess);
  };
  int flat = 0;
  for (int i = 0; i < 20000; ++i) {
    LightCriterion light;
    light.to_light = unit_vector(random);
    light.shininess = uniform(random, 1, 60);
    const float angle = uniform(random, 0, 1.5f);
    const RegionBounds region{{point_in_cube(random, 1), 0.1f},
                              {unit_vector(random), std::cos(angle), std::sin(angle)},
                              0.01f};
    const Vec3 eye = 4.0f * unit_vector(random);
    const Vec3 half = glm::normalize(glm::normalize(eye - region.ball.center) + light.to_light);
    const float change = shading_change(light, region, eye);
    float low = 10, high = 0;
    for (int j = 0; j < 10; ++j) {
      const float shaded = shade(light, normal_in(region.cone, random), half);
      low = std::min(low, shaded);
      high = std::max(high, shaded);
    }
    EXPECT_LE(high - low, change + 1e-4f);
    flat += change == 0 ? 1 : 0;
  }
  EXPECT_GT(flat, 100);  // in the dark nothing changes
  // Towards the light little, across it much.
  LightCriterion light;
  light.specular = 0;
  const NormalCone facing_light{{0, 0, 1}, std::cos(0.3f), std::sin(0.3f)};
  const NormalCone across{{1, 0, 0}, std::cos(0.3f), std::sin(0.3f)};
  const Sphere ball{{0, 0, 0}, 0.1f};
  EXPECT_LT(shading_change(light, {ball, facing_light, 0}, {0, 0, 5}),
            shading_change(light, {ball, across, 0}, {0, 0, 5}));
  ViewCriterion view(front_camera());
  const float plain = view.urgency({ball, facing_light, 0.01f});
  view.light = light;
  EXPECT_LT(view.urgency({ball, facing_light, 0.01f}), plain);
  EXPECT_GE(view.urgency({ball, facing_light, 0.01f}), light.least_weight * plain * 0.999f);
}

}  // namespace
}  // namespace varifold
