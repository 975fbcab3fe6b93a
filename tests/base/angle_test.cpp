#include <gtest/gtest.h>

#include <varifold/base/angle.h>
#include <cmath>

namespace varifold {
namespace {

constexpr double kPi = 3.14159265358979323846;

TEST(UnitCircle, QuartersAndEighthsAreExact) {
  EXPECT_EQ(unit_circle(0, 12), glm::dvec2(1, 0));
  EXPECT_EQ(unit_circle(3, 12), glm::dvec2(0, 1));
  EXPECT_EQ(unit_circle(6, 12), glm::dvec2(-1, 0));
  EXPECT_EQ(unit_circle(9, 12), glm::dvec2(0, -1));
  EXPECT_EQ(unit_circle(12, 12), glm::dvec2(1, 0));
  const glm::dvec2 eighth = unit_circle(1, 8);
  EXPECT_DOUBLE_EQ(eighth.x, std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(eighth.y, std::sqrt(0.5));
}

TEST(UnitCircle, AgreesWithLibm) {
  for (const std::uint64_t n : {1u, 3u, 7u, 64u, 1001u})
    for (std::uint64_t k = 0; k < 2 * n; ++k) {
      const glm::dvec2 p = unit_circle(k, n);
      const double angle = 2 * kPi * static_cast<double>(k) / static_cast<double>(n);
      ASSERT_NEAR(p.x, std::cos(angle), 3e-15);
      ASSERT_NEAR(p.y, std::sin(angle), 3e-15);
    }
}

TEST(UnitCircle, MirrorImagesHaveTheSameBits) {
  for (std::uint64_t k = 0; k <= 100; ++k) {
    const glm::dvec2 p = unit_circle(k, 100), q = unit_circle(100 - k, 100);
    ASSERT_EQ(p.x, q.x);
    ASSERT_EQ(p.y, -q.y);
  }
}

TEST(HalfAngleTangent, AgreesWithLibm) {
  for (double degrees = 0.01; degrees < 180; degrees += 0.37) {
    const double exact = std::tan(degrees * 3.14159265358979323846 / 360);
    EXPECT_NEAR(half_angle_tangent(degrees), exact, 1e-13 * exact) << degrees;
  }
  EXPECT_EQ(half_angle_tangent(0), 0);
  EXPECT_DOUBLE_EQ(half_angle_tangent(90), 1);
}

TEST(ArcCosine, AgreesWithLibmAndClamps) {
  for (int i = -1000; i <= 1000; ++i)
    ASSERT_NEAR(arc_cosine(i / 1000.0), std::acos(i / 1000.0), 3e-8);
  EXPECT_EQ(arc_cosine(1), 0);
  EXPECT_EQ(arc_cosine(1.5), 0);
  EXPECT_DOUBLE_EQ(arc_cosine(-1.5), kPi);
}

}  // namespace
}  // namespace varifold
