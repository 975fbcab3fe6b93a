#include <gtest/gtest.h>
#include <varifold/base/random.h>
#include <varifold/morph/sphere_point.h>
#include <array>

namespace varifold {
namespace {

// Sign of the determinant by schoolbook arithmetic in digits of 2^21: shares nothing with the
// predicate, which takes differences first.
int slow_sign(const SpherePoint& a, const SpherePoint& b, const SpherePoint& c) {
  constexpr std::int64_t kBase = 1 << 21;
  std::array<std::int64_t, 8> sum{};
  const auto add = [&](std::int64_t x, std::int64_t y, std::int64_t z, int sign) {
    const std::int64_t digits[3][2] = {
        {x % kBase, x / kBase}, {y % kBase, y / kBase}, {z % kBase, z / kBase}};
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        const std::int64_t product = digits[0][i] * digits[1][j];
        for (int k = 0; k < 2; ++k) {
          const std::int64_t low = (product % kBase) * digits[2][k];
          const std::int64_t high = (product / kBase) * digits[2][k];
          sum[i + j + k] += sign * (low % kBase);
          sum[i + j + k + 1] += sign * (low / kBase + high % kBase);
          sum[i + j + k + 2] += sign * (high / kBase);
        }
      }
  };
  add(a.x, b.y, c.z, 1), add(a.y, b.z, c.x, 1), add(a.z, b.x, c.y, 1);
  add(a.z, b.y, c.x, -1), add(a.y, b.x, c.z, -1), add(a.x, b.z, c.y, -1);
  for (std::size_t i = 0; i + 1 < sum.size(); ++i) {
    std::int64_t carry = sum[i] / kBase;
    if (sum[i] % kBase < 0) --carry;
    sum[i] -= carry * kBase;
    sum[i + 1] += carry;
  }
  if (sum.back() < 0) return -1;
  for (const std::int64_t digit : sum)
    if (digit != 0) return 1;
  return 0;
}

SpherePoint random_point(Random& random) {
  return to_sphere_point({random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5});
}

TEST(SpherePoint, SignsAreExactNearGreatCircles) {
  Random random(3);
  int zeros = 0, signs[2] = {0, 0};
  for (int i = 0; i < 20'000; ++i) {
    const SpherePoint a = random_point(random), b = random_point(random);
    // On the great circle of both but for rounding, and sometimes a few units of the grid off.
    const double s = random.uniform(), t = random.uniform();
    SpherePoint c = to_sphere_point(s * direction(a) + t * direction(b));
    c.x += static_cast<std::int64_t>(random.below(3)) - 1;
    const int sign = orientation(a, b, c);
    ASSERT_EQ(sign, slow_sign(a, b, c));
    ASSERT_EQ(orientation(b, c, a), sign);
    ASSERT_EQ(orientation(b, a, c), -sign);
    zeros += sign == 0;
    ++signs[sign > 0];
  }
  EXPECT_GT(signs[0], 1000);
  EXPECT_GT(signs[1], 1000);
  EXPECT_EQ(orientation({1, 0, 0}, {0, 1, 0}, {5, 7, 0}), 0);
}

TEST(SpherePoint, SignsOfTinyTriangles) {
  Random random(4);
  for (int i = 0; i < 20'000; ++i) {
    const SpherePoint a = random_point(random);
    const auto near = [&] {
      return SpherePoint{a.x + random.below(5), a.y + random.below(5), a.z + random.below(5)};
    };
    const SpherePoint b = near(), c = near();
    ASSERT_EQ(orientation(a, b, c), slow_sign(a, b, c));
  }
}

}  // namespace
}  // namespace varifold
