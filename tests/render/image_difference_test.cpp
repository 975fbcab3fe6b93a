#include <gtest/gtest.h>

#include <varifold/render/image_difference.h>
#include <cmath>

namespace varifold {
namespace {

TEST(ImageDifference, IsExactOnFourPixels) {
  const Image8 a{2, 2, {10, 10, 10, 20, 20, 20, 30, 30, 30, 40, 40, 40}};
  Image8 b = a;
  EXPECT_EQ(image_difference(a, b)->max, 0);
  EXPECT_EQ(image_difference(a, b)->rms, 0);
  b.rgb[1] = 13;  // pixel 0 by 3
  b.rgb[9] = 36;  // pixel 3 by 4
  const auto difference = image_difference(a, b, 3);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->max, 4);
  EXPECT_DOUBLE_EQ(difference->rms, std::sqrt(25.0 / 12));
  EXPECT_DOUBLE_EQ(difference->part_above, 0.25);
  EXPECT_DOUBLE_EQ(image_difference(a, b)->part_above, 0.5);
}

TEST(ImageDifference, RefusesDifferentSizesAndTakesEmptyPictures) {
  const Image8 a{1, 2, std::vector<std::uint8_t>(6)};
  const Image8 b{2, 1, std::vector<std::uint8_t>(6)};
  EXPECT_EQ(image_difference(a, b).error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(image_difference(Image8{}, Image8{})->max, 0);
}

}  // namespace
}  // namespace varifold
