#include <gtest/gtest.h>

#include <tests/view/random_points.h>
#include <varifold/view/camera.h>
#include <limits>
#include <vector>

namespace varifold {
namespace {

using test::point_in_ball;
using test::point_in_cube;
using test::uniform;
using test::unit_vector;

Vec3 project(const Camera& camera, const Vec3& point) {
  const Vec4 clip = view_projection_matrix(camera) * Vec4(point, 1);
  return Vec3(clip) / clip.w;
}

TEST(Camera, ProjectsTheTargetToTheMiddleAndUpUpwards) {
  Camera camera;
  camera.eye = {0, 0, 5};
  const Vec3 middle = project(camera, camera.target);
  EXPECT_NEAR(middle.x, 0, 1e-6);
  EXPECT_NEAR(middle.y, 0, 1e-6);
  EXPECT_GT(project(camera, {0, 1, 0}).y, 0.1f);
  EXPECT_GT(project(camera, {1, 0, 0}).x, 0.1f);
  EXPECT_LT(project(camera, {0, 0, 1}).z, project(camera, {0, 0, -1}).z);
}

TEST(Camera, KnowsWhenItIsNotUsable) {
  EXPECT_TRUE(is_usable(Camera{}));
  Camera camera;
  camera.target = camera.eye;
  EXPECT_FALSE(is_usable(camera));
  camera = {};
  camera.up = {0, 0, 2};
  EXPECT_FALSE(is_usable(camera));
  camera = {};
  camera.fovy_degrees = 180;
  EXPECT_FALSE(is_usable(camera));
  camera = {};
  camera.width = 0;
  EXPECT_FALSE(is_usable(camera));
  camera = {};
  camera.near_distance = camera.far_distance;
  EXPECT_FALSE(is_usable(camera));
  camera = {};
  camera.eye.x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(is_usable(camera));
}

TEST(Camera, DepthRangeHoldsTheSceneFromOutsideInsideAndBehind) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Sphere scene{point_in_cube(random, 10), uniform(random, 0.01f, 5)};
    Camera camera;
    camera.eye = point_in_cube(random, 20);
    camera.target = point_in_cube(random, 1) + camera.eye + Vec3(0.01f);
    set_depth_range(camera, scene);
    ASSERT_TRUE(is_usable(camera));
    for (int k = 0; k < 20; ++k) {
      const Vec3 p = scene.center + scene.radius * point_in_ball(random);
      const float depth = glm::dot(p - camera.eye, view_direction(camera));
      if (depth < camera.far_distance / 19000) continue;
      EXPECT_GE(depth, camera.near_distance);
      EXPECT_LE(depth, camera.far_distance);
    }
  }
}

TEST(Frame, HoldsAllPointsAndTouchesTheMarginOfOneDirection) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    FrameOptions options;
    options.width = 100 + static_cast<int>(random.below(900));
    options.height = 100 + static_cast<int>(random.below(900));
    options.fovy_degrees = uniform(random, 10, 70);
    options.azimuth_degrees = uniform(random, -180, 180);
    options.elevation_degrees = uniform(random, -80, 80);
    options.up = unit_vector(random);
    options.margin = uniform(random, 0, 0.3f);
    const Vec3 stretch = point_in_cube(random, 2) + Vec3(2.1f);
    const Vec3 center = point_in_cube(random, 5);
    std::vector<Vec3> points;
    for (int k = 0; k < 50; ++k) points.push_back(center + stretch * point_in_ball(random));

    const Camera camera = frame(points, options);
    ASSERT_TRUE(is_usable(camera));
    Vec3 low(2), high(-2);
    for (const Vec3& p : points) {
      low = glm::min(low, project(camera, p));
      high = glm::max(high, project(camera, p));
    }
    const float free = 1 - options.margin;
    EXPECT_LE(std::max({-low.x, high.x, -low.y, high.y}), free + 1e-3f);
    EXPECT_GE(low.z, -1);
    EXPECT_LE(high.z, 1);
    const bool fills_x = low.x < -free + 2e-3f && high.x > free - 2e-3f;
    const bool fills_y = low.y < -free + 2e-3f && high.y > free - 2e-3f;
    EXPECT_TRUE(fills_x || fills_y) << "the picture is not filled";
  }
}

TEST(Frame, CopesWithNothingOnePointAndFlatBoxes) {
  EXPECT_TRUE(is_usable(frame(Box{})));
  for (const Vec3 place : {Vec3(0), Vec3(1000, -50, 3)}) {
    const Camera camera = frame(Box{place, place});
    ASSERT_TRUE(is_usable(camera));
    EXPECT_NEAR(project(camera, place).x, 0, 1e-2);
  }
  FrameOptions above;
  above.elevation_degrees = 90;
  EXPECT_TRUE(is_usable(frame(Box{{0, 0, 0}, {1, 0, 1}}, above)));
  EXPECT_TRUE(is_usable(frame(Box{{0, 0, 0}, {0, 2, 0}})));
}

TEST(Frame, LooksDownAtTheFrontForEveryUp) {
  for (const Vec3 up : {Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, -1, 0)}) {
    FrameOptions options;
    options.up = up;
    const Camera camera = frame(Box{Vec3(-1), Vec3(1)}, options);
    EXPECT_LT(glm::dot(view_direction(camera), up), -0.2f);
    EXPECT_GT(project(camera, 0.5f * up).y, project(camera, -0.5f * up).y);
  }
}

TEST(PixelScale, MatchesTheProjectionInTheMiddleOfThePicture) {
  Camera camera;
  camera.eye = {1, 2, 3};
  camera.target = {4, -2, 9};
  const Vec3 across = glm::normalize(glm::cross(view_direction(camera), camera.up));
  for (const float distance : {0.5f, 3.0f, 40.0f}) {
    const Vec3 point = camera.eye + distance * view_direction(camera);
    const float error = 0.02f * distance;
    const float ndc = project(camera, point + error * across).x - project(camera, point).x;
    const float pixels = 0.5f * ndc * static_cast<float>(camera.width);
    EXPECT_NEAR(pixels_of(camera, error, point), pixels, 0.01f * pixels);
    EXPECT_NEAR(pixels_of(camera, pixel_size(camera, distance), point), 1, 1e-4);
  }
}

TEST(PixelScale, ErrorOfIsTheInverseAndBallsAreUpperBounds) {
  Random random(3);
  const Camera camera;
  const PixelScale scale(camera);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 point = point_in_cube(random, 10);
    EXPECT_NEAR(scale.pixels_of(scale.error_of(2.5f, point), point), 2.5f, 1e-4);
    const Sphere ball{point, uniform(random, 0, 3)};
    const Vec3 inside = point + ball.radius * point_in_ball(random);
    EXPECT_LE(scale.pixels_of(1, inside), scale.pixels_of(1, ball) * 1.0001f);
  }
  EXPECT_TRUE(std::isfinite(scale.pixels_of(1, camera.eye)));
}

}  // namespace
}  // namespace varifold
