#include <gtest/gtest.h>

#include <varifold/base/random.h>
#include <varifold/mesh/noise.h>
#include <algorithm>
#include <cmath>

namespace varifold {
namespace {

TEST(GradientNoise, IsZeroOnTheLattice) {
  const GradientNoise noise(1);
  for (int x = -3; x <= 3; ++x)
    for (int y = -3; y <= 3; ++y) EXPECT_EQ(noise(DVec3(x, y, 2 - x)), 0);
}

TEST(GradientNoise, IsBoundedAndContinuousAcrossCells) {
  const GradientNoise noise(2);
  Random random(5);
  double highest = 0;
  for (int i = 0; i < 20'000; ++i) {
    const DVec3 p(20 * random.uniform() - 10, 20 * random.uniform() - 10,
                  std::floor(8 * random.uniform()) - 4);
    const double value = noise(p);
    highest = std::max(highest, std::abs(value));
    // p.z is on the border of two cells.
    ASSERT_NEAR(value, noise(p - DVec3(0, 0, 1e-9)), 1e-7);
  }
  EXPECT_GT(highest, 0.5);
  EXPECT_LT(highest, 1.1);
}

TEST(GradientNoise, SeedsDiffer) {
  const DVec3 p(0.3, 0.4, 0.7);
  EXPECT_NE(GradientNoise(1)(p), GradientNoise(2)(p));
  EXPECT_EQ(GradientNoise(1)(p), GradientNoise(1)(p));
}

TEST(FractalNoise, OneOctaveIsTheNoise) {
  const GradientNoise noise(3);
  const DVec3 p(0.3, -0.4, 0.7);
  EXPECT_EQ(fractal_noise(noise, p, {.frequency = 2, .octaves = 1}).smooth, noise(2.0 * p));
  EXPECT_EQ(fractal_noise(noise, p, {.octaves = 0}).smooth, 0);
}

}  // namespace
}  // namespace varifold
