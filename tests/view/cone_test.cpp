#include <gtest/gtest.h>

#include <tests/view/random_points.h>
#include <varifold/view/cone.h>
#include <cmath>
#include <vector>

namespace varifold {
namespace {

using test::point_in_ball;
using test::point_in_cube;
using test::uniform;
using test::unit_vector;

std::vector<Vec3> normals_near(Random& random, const Vec3& axis, float spread) {
  std::vector<Vec3> normals;
  for (int i = 0; i < 12; ++i)
    normals.push_back(glm::normalize(axis + spread * point_in_ball(random)));
  return normals;
}

TEST(NormalCone, HoldsTheNormalsItIsMadeFrom) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const auto normals = normals_near(random, unit_vector(random), uniform(random, 0, 0.95f));
    const NormalCone cone = cone_around(normals);
    for (const Vec3& n : normals) EXPECT_GE(glm::dot(n, cone.axis), cone.cosine);
    EXPECT_NEAR(cone.sine * cone.sine + cone.cosine * cone.cosine, 1, 1e-5);
  }
}

TEST(NormalCone, OfNothingOrOfOppositesHoldsEverything) {
  EXPECT_TRUE(cone_around({}).is_wide());
  const Vec3 opposite[] = {{1, 0, 0}, {-1, 0, 0}};
  EXPECT_TRUE(cone_around(opposite).is_wide());
  const Vec3 with_zero[] = {{0, 0, 1}, {0, 0, 0}};
  EXPECT_FALSE(cone_around(with_zero).is_wide());
}

// Whatever the cone claims must hold for every point of the ball with every normal.
TEST(NormalCone, NeverCallsAVisiblePointBackFacing) {
  Random random(2);
  int counts[3] = {0, 0, 0};
  for (int i = 0; i < 20000; ++i) {
    const auto normals = normals_near(random, unit_vector(random), uniform(random, 0, 0.9f));
    const NormalCone cone = cone_around(normals);
    const Sphere ball{point_in_cube(random, 1), uniform(random, 0, 1)};
    const Vec3 eye = point_in_cube(random, 3);
    const Facing result = facing(cone, ball, eye);
    ++counts[static_cast<int>(result)];
    for (const Vec3& n : normals) {
      const Vec3 on_sphere = ball.center + ball.radius * unit_vector(random);
      const Vec3 extreme = ball.center - ball.radius * n;  // the most visible for this normal
      for (const Vec3& p : {on_sphere, extreme, ball.center + ball.radius * n}) {
        if (result == Facing::kBack) {
          EXPECT_GT(glm::dot(n, p - eye), -1e-4f);
        }
        if (result == Facing::kFront) {
          EXPECT_LT(glm::dot(n, p - eye), 1e-4f);
        }
      }
    }
  }
  for (const int count : counts) EXPECT_GT(count, 1000);
}

// The paper's test without the radius fails here: the centre looks away, a near point does not.
TEST(NormalCone, RadiusMattersCloseUp) {
  const Vec3 up[] = {{0, 1, 0}};
  const NormalCone cone = cone_around(up);
  const Vec3 eye(0, 0, 0);
  EXPECT_TRUE(is_back_facing(cone, Sphere{{0, 0.5f, -2}, 0}, eye));
  EXPECT_FALSE(is_back_facing(cone, Sphere{{0, 0.5f, -2}, 0.6f}, eye));
  EXPECT_TRUE(is_back_facing(cone, Sphere{{0, 0.5f, -2}, 0.4f}, eye));
  EXPECT_FALSE(is_back_facing(cone, Sphere{{0, 0.5f, 0}, 1.0f}, eye)) << "the eye is inside";
}

}  // namespace
}  // namespace varifold
