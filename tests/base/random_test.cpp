#include <gtest/gtest.h>

#include <varifold/base/random.h>
#include <array>

namespace varifold {
namespace {

TEST(Random, IsSplitMix64) {
  // The published first outputs for the seed 1234567.
  Random random(1234567);
  EXPECT_EQ(random.next(), 6457827717110365317u);
  EXPECT_EQ(random.next(), 3203168211198807973u);
  EXPECT_EQ(random.next(), 9817491932198370423u);
}

TEST(Random, UniformAndBelowStayInRangeAndSpread) {
  Random random(1);
  std::array<int, 10> histogram{};
  double sum = 0;
  for (int i = 0; i < 10'000; ++i) {
    const double x = random.uniform();
    ASSERT_GE(x, 0);
    ASSERT_LT(x, 1);
    sum += x;
    ++histogram.at(random.below(10));
  }
  EXPECT_NEAR(sum / 10'000, 0.5, 0.02);
  for (const int n : histogram) EXPECT_NEAR(n, 1000, 150);
  EXPECT_EQ(Random(3).below(1), 0u);
}

}  // namespace
}  // namespace varifold
