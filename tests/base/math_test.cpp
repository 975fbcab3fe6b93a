#include <gtest/gtest.h>

#include <varifold/base/math.h>
#include <limits>

namespace varifold {
namespace {

TEST(Box, IsEmptyUntilAPointIsAdded) {
  Box box;
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.diagonal(), 0.0f);
  EXPECT_EQ(box.center(), Vec3(0));
  box.add({1, 2, 3});
  EXPECT_FALSE(box.empty());
  EXPECT_EQ(box.center(), Vec3(1, 2, 3));
  box.add({4, 6, 3});
  EXPECT_EQ(box.lower, Vec3(1, 2, 3));
  EXPECT_EQ(box.upper, Vec3(4, 6, 3));
  EXPECT_EQ(box.diagonal(), 5.0f);
}

TEST(NormalizeOrZero, GivesUnitVectorsOrZero) {
  EXPECT_EQ(normalize_or_zero({0, 3, 0}), Vec3(0, 1, 0));
  EXPECT_EQ(normalize_or_zero(Vec3(0)), Vec3(0));
  EXPECT_EQ(normalize_or_zero(Vec3(std::numeric_limits<float>::max())), Vec3(0));
  EXPECT_EQ(normalize_or_zero(Vec3(std::numeric_limits<float>::quiet_NaN())), Vec3(0));
}

}  // namespace
}  // namespace varifold
