#include <varifold/simplify/quadric.h>

#include <gtest/gtest.h>
#include <varifold/base/random.h>

namespace varifold {
namespace {

Vec3 random_vector(Random& random) {
  return {static_cast<float>(random.uniform() - 0.5), static_cast<float>(random.uniform() - 0.5),
          static_cast<float>(random.uniform() - 0.5)};
}

TEST(Quadric, IsTheWeightedSquaredDistanceToAPlane) {
  Quadric quadric;
  quadric.add_plane(Vec3(0, 0, 1), 3);
  EXPECT_FLOAT_EQ(quadric.at(Vec3(7, -5, 2)), 12);
  EXPECT_FLOAT_EQ(quadric.at(Vec3(7, -5, 0)), 0);
}

TEST(Quadric, IsTheWeightedSquaredDistanceToAPoint) {
  Quadric quadric;
  quadric.add_point(2);
  EXPECT_FLOAT_EQ(quadric.at(Vec3(1, 2, 2)), 18);
}

TEST(Quadric, IsTheSameFunctionAfterAMove) {
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    Quadric quadric;
    for (int k = 0; k < 5; ++k)
      quadric.add_plane(normalize_or_zero(random_vector(random)),
                        static_cast<float>(random.uniform()));
    const Vec3 move = random_vector(random);
    const Vec3 d = random_vector(random);
    EXPECT_NEAR(quadric.moved_by(move).at(d), quadric.at(move + d), 1e-5);
    EXPECT_NEAR(quadric.moved_by(move).c, quadric.at(move), 1e-6);
  }
}

}  // namespace
}  // namespace varifold
