// Height fields at other resolutions.
#include <gtest/gtest.h>

#include <varifold/base/random.h>
#include <varifold/mesh/generators.h>
#include <algorithm>
#include <cstdint>

namespace varifold {
namespace {

HeightField random_field(std::uint32_t width, std::uint32_t height) {
  HeightField field{width, height, {}, 0.5f, 2};
  Random random(9);
  for (std::uint32_t i = 0; i < width * height; ++i)
    field.heights.push_back(static_cast<float>(random.uniform()));
  return field;
}

TEST(ResampleHeights, TheSameSizeChangesNothing) {
  const HeightField field = random_field(17, 9);
  const HeightField same = resample(field, 17, 9);
  EXPECT_EQ(same.heights, field.heights);
  EXPECT_EQ(same.spacing, field.spacing);
}

TEST(ResampleHeights, MoreSamplesAreInterpolated) {
  const HeightField field{2, 2, {0, 1, 2, 3}, 4, 1};
  const HeightField fine = resample(field, 5, 3);
  ASSERT_EQ(fine.heights.size(), 15u);
  for (std::uint32_t row = 0; row < 3; ++row)
    for (std::uint32_t column = 0; column < 5; ++column)
      EXPECT_FLOAT_EQ(fine.heights[row * 5 + column],
                      0.25f * static_cast<float>(column) + static_cast<float>(row));
  EXPECT_EQ(fine.spacing, 1);
  EXPECT_EQ(fine.row_spacing, 2);
}

TEST(ResampleHeights, FewerSamplesAreMeans) {
  // Three samples to two: tents of reach 2 about the corners.
  const HeightField coarse = resample({3, 2, {0, 3, 6, 0, 3, 6}, 1, 1}, 2, 2);
  EXPECT_FLOAT_EQ(coarse.heights[0], 1);  // (0 * 1 + 3 * 1/2) / (3/2)
  EXPECT_FLOAT_EQ(coarse.heights[1], 5);
}

TEST(ResampleHeights, MeansStayWithinTheHeightsAndKeepTheExtent) {
  const HeightField field = random_field(120, 77);
  const auto bounds = [](const HeightField& f) {
    return std::minmax_element(f.heights.begin(), f.heights.end());
  };
  for (const auto& [width, height] : {std::pair{60u, 60u}, {13u, 200u}, {2u, 2u}, {119u, 76u}}) {
    const HeightField other = resample(field, width, height);
    EXPECT_GE(*bounds(other).first, *bounds(field).first);
    EXPECT_LE(*bounds(other).second, *bounds(field).second);
    const auto mesh = terrain(other);
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->vertex_count(), width * height);
    EXPECT_NEAR(mesh->positions.back().x, 0.25f * 119, 1e-4);
    EXPECT_NEAR(mesh->positions.back().z, 0.25f * 76, 1e-4);
  }
}

TEST(ResampleHeights, TheSameBitsForAnyNumberOfThreads) {
  const HeightField field = random_field(301, 203);
  EXPECT_EQ(resample(field, 128, 99, 1).heights, resample(field, 128, 99, 3).heights);
}

}  // namespace
}  // namespace varifold
