#include <gtest/gtest.h>

#include <tests/view/random_points.h>
#include <varifold/view/frustum.h>

namespace varifold {
namespace {

using test::point_in_ball;
using test::point_in_cube;
using test::uniform;

Camera random_camera(Random& random) {
  Camera camera;
  camera.eye = point_in_cube(random, 5);
  camera.target = camera.eye + test::unit_vector(random) * 2.0f;
  camera.up = test::unit_vector(random);
  camera.fovy_degrees = uniform(random, 20, 110);
  camera.width = 200 + static_cast<int>(random.below(800));
  camera.near_distance = uniform(random, 0.1f, 1);
  camera.far_distance = camera.near_distance + uniform(random, 1, 20);
  return camera;
}

/// Brute force: the point as the matrices see it; a little slack either way.
bool projects_inside(const Camera& camera, const Vec3& point, float slack) {
  const Vec4 clip = view_projection_matrix(camera) * Vec4(point, 1);
  const float w = clip.w + slack;
  return std::abs(clip.x) <= w && std::abs(clip.y) <= w && std::abs(clip.z) <= w;
}

TEST(Frustum, ContainsWhatTheMatricesProjectInside) {
  Random random(1);
  int inside = 0;
  for (int i = 0; i < 200; ++i) {
    const Camera camera = random_camera(random);
    if (!is_usable(camera)) continue;
    const Frustum frustum = frustum_of(camera);
    for (int k = 0; k < 200; ++k) {
      const Vec3 p = point_in_cube(random, 12);
      if (projects_inside(camera, p, -1e-3f)) {
        EXPECT_TRUE(contains(frustum, p));
        ++inside;
      } else if (!projects_inside(camera, p, 1e-3f)) {
        EXPECT_FALSE(contains(frustum, p));
      }
    }
  }
  EXPECT_GT(inside, 500);
}

TEST(Frustum, SpheresAreNeverOutsideOrInsideWrongly) {
  Random random(2);
  int counts[3] = {0, 0, 0};
  for (int i = 0; i < 5000; ++i) {
    const Camera camera = random_camera(random);
    if (!is_usable(camera)) continue;
    const Frustum frustum = frustum_of(camera);
    const Sphere sphere{point_in_cube(random, 8), uniform(random, 0, 1.5f)};
    const Containment result = classify(frustum, sphere);
    ++counts[static_cast<int>(result)];
    for (int k = 0; k < 30; ++k) {
      const Vec3 p = sphere.center + sphere.radius * point_in_ball(random);
      if (result == Containment::kOutside) {
        EXPECT_FALSE(projects_inside(camera, p, -1e-3f));
      }
      if (result == Containment::kInside) {
        EXPECT_TRUE(projects_inside(camera, p, 1e-3f));
      }
    }
  }
  for (const int count : counts) EXPECT_GT(count, 100);
}

TEST(Frustum, BoxesAreNeverOutsideOrInsideWrongly) {
  Random random(3);
  int counts[3] = {0, 0, 0};
  for (int i = 0; i < 5000; ++i) {
    const Camera camera = random_camera(random);
    if (!is_usable(camera)) continue;
    const Frustum frustum = frustum_of(camera);
    const Vec3 corner = point_in_cube(random, 8);
    const Box box{corner, corner + 0.5f * (point_in_cube(random, 1) + Vec3(1))};
    const Containment result = classify(frustum, box);
    ++counts[static_cast<int>(result)];
    for (int k = 0; k < 30; ++k) {
      const Vec3 part = 0.5f * (point_in_cube(random, 1) + Vec3(1));
      const Vec3 p = box.lower + part * (box.upper - box.lower);
      if (result == Containment::kOutside) {
        EXPECT_FALSE(projects_inside(camera, p, -1e-3f));
      }
      if (result == Containment::kInside) {
        EXPECT_TRUE(projects_inside(camera, p, 1e-3f));
      }
    }
  }
  for (const int count : counts) EXPECT_GT(count, 100);
}

TEST(Frustum, SeesTheOutsideOfEachSide) {
  Camera camera;  // at z = 3, looks at the origin, near 0.1, far 100
  const Frustum frustum = frustum_of(camera);
  const Vec3 outside[] = {{-9, 0, 0}, {9, 0, 0}, {0, -9, 0}, {0, 9, 0}, {0, 0, 2.95f}, {0, 0, -99}};
  for (const Vec3& center : outside)
    EXPECT_EQ(classify(frustum, Sphere{center, 0.01f}), Containment::kOutside);
  EXPECT_EQ(classify(frustum, Sphere{{0, 0, 0}, 0.1f}), Containment::kInside);
  EXPECT_EQ(classify(frustum, Sphere{{0, 0, 0}, 2.0f}), Containment::kIntersects);
  EXPECT_EQ(classify(frustum, Sphere{}), Containment::kOutside);
  EXPECT_EQ(classify(frustum, Box{}), Containment::kOutside);
}

}  // namespace
}  // namespace varifold
