#include <gtest/gtest.h>

#include <varifold/render/colors.h>

namespace varifold {
namespace {

TEST(Colors, SrgbKeepsBlackAndWhiteAndDarkensTheMiddle) {
  EXPECT_EQ(linear_from_srgb(Vec3(0)), Vec3(0));
  EXPECT_NEAR(linear_from_srgb(Vec3(1)).x, 1, 1e-6);
  EXPECT_NEAR(linear_from_srgb(Vec3(0.5f)).y, 0.21404f, 1e-4);
  EXPECT_NEAR(linear_from_srgb(Vec3(0.04f)).z, 0.04f / 12.92f, 1e-6);
}

TEST(Colors, LevelsGoFromBlueToOrangeWithoutJumps) {
  EXPECT_GT(level_color(0).z, level_color(0).x);
  EXPECT_GT(level_color(1).x, level_color(1).z);
  EXPECT_EQ(level_color(-1), level_color(0));
  EXPECT_EQ(level_color(2), level_color(1));
  for (int i = 0; i < 1000; ++i) {
    const float level = static_cast<float>(i) / 1000;
    EXPECT_LT(glm::length(level_color(level + 0.001f) - level_color(level)), 0.01f);
  }
}

TEST(Colors, StripsDifferFromTheirNeighboursAndAreNotRed) {
  int similar = 0;
  for (std::uint32_t strip = 0; strip < 10000; ++strip) {
    const Vec3 color = strip_color(strip);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(color[c], 0);
      EXPECT_LE(color[c], 1);
    }
    EXPECT_FALSE(color.x > color.y + 0.22f && color.x > color.z + 0.22f) << strip;
    if (glm::length(color - strip_color(strip + 1)) < 0.1f) ++similar;
  }
  EXPECT_LT(similar, 300);
}

}  // namespace
}  // namespace varifold
