#include <varifold/models/vdpm/deviation_space.h>

#include <gtest/gtest.h>
#include <tests/view/random_points.h>

namespace varifold {
namespace {

TEST(DeviationSpace, TablesAreWhatTheySay) {
  using namespace deviation_space;
  for (std::size_t i = 0; i < kRatios.size(); ++i) {
    const double ratio = kRatios[i];
    EXPECT_FLOAT_EQ(kSlopes[i], static_cast<float>(std::sqrt(ratio * ratio - 1)));
    EXPECT_FLOAT_EQ(kInverses[i], static_cast<float>(1 / ratio));
    EXPECT_FLOAT_EQ(kMeanExtents[i], static_cast<float>(mean_extent(ratio)));
  }
}

TEST(DeviationSpace, MeanExtentIsTheMeanOverAllDirections) {
  for (const DeviationSpace space : {DeviationSpace{2, 1}, {2, 2}, {1, 3}, {0.1f, 5}, {0, 4}}) {
    double sum = 0;
    constexpr int kParts = 20000;
    // The cosine to the axis is uniform.
    for (int i = 0; i < kParts; ++i) {
      const double cosine = (i + 0.5) / kParts;
      sum += std::max(double{space.mu}, space.delta * std::sqrt(1 - cosine * cosine));
    }
    EXPECT_NEAR(space.mean_extent(), sum / kParts, 1e-3 * sum / kParts);
  }
}

TEST(DeviationSpace, HoldsWhatWasGatheredFromEverySide) {
  Random random(3);
  for (int trial = 0; trial < 400; ++trial) {
    // Flat and tall clouds.
    const float across = std::exp(test::uniform(random, -6, 2));
    const std::uint32_t count = 1 + random.below(8);
    std::vector<Vec3> residuals;
    DeviationGatherer space, halves[2];
    double longest = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      Vec3 e = test::point_in_cube(random, 1);
      e.x *= across, e.y *= across;
      residuals.push_back(e);
      const float aside = std::sqrt(e.x * e.x + e.y * e.y);
      space.add(std::abs(e.z), aside);
      halves[i % 2].add(std::abs(e.z), aside);
      longest = std::max(longest, glm::length(DVec3(e)));
    }
    const DeviationSpace best = space.best();
    halves[0].add(halves[1]);
    EXPECT_EQ(halves[0].best().mu, best.mu);
    EXPECT_EQ(halves[0].best().delta, best.delta);
    EXPECT_GE(best.delta, best.mu);
    EXPECT_LE(best.mean_extent(), longest * 1.0001);  // no worse than a ball
    for (int i = 0; i < 200; ++i) {
      // The angle to the axis may be small; from all sides about it.
      const double angle = random.uniform() * random.uniform() * 1.5707963;
      const double turn = random.uniform() * 6.2831853;
      const DVec3 seen(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                       std::cos(angle));
      const double extent = std::max(double{best.mu}, best.delta * std::sin(angle));
      for (const Vec3& e : residuals)
        ASSERT_LE(glm::length(glm::cross(DVec3(e), seen)), extent * (1 + 1e-5));
    }
  }
}

TEST(DeviationSpace, IsTallForVectorsAlongTheAxis) {
  DeviationGatherer space;
  space.add(1, 0);
  space.add(0.5f, 0.001f);
  EXPECT_LE(space.best().mu, 0.0201f);
  EXPECT_LE(space.best().delta, 1.0001f);
  EXPECT_LT(space.best().mean_extent(), 0.79f);  // pi / 4 and a little
}

}  // namespace
}  // namespace varifold
