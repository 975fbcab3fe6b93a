#include <gtest/gtest.h>

#include <varifold/base/random.h>
#include <varifold/measure/closest_point.h>
#include <algorithm>
#include <cmath>

namespace varifold {
namespace {

// c
// |\      The seven regions of a right triangle.
// a-b
const DVec3 kA(0, 0, 0), kB(1, 0, 0), kC(0, 1, 0);

TEST(ClosestOnTriangle, InEveryRegion) {
  EXPECT_EQ(closest_on_triangle({0.25, 0.25, 3}, kA, kB, kC), DVec3(0.25, 0.25, 0));
  EXPECT_EQ(closest_on_triangle({-1, -1, 1}, kA, kB, kC), kA);
  EXPECT_EQ(closest_on_triangle({3, 0.5, 1}, kA, kB, kC), kB);
  EXPECT_EQ(closest_on_triangle({0.5, 3, 1}, kA, kB, kC), kC);
  EXPECT_EQ(closest_on_triangle({0.5, -1, 1}, kA, kB, kC), DVec3(0.5, 0, 0));
  EXPECT_EQ(closest_on_triangle({-1, 0.5, 1}, kA, kB, kC), DVec3(0, 0.5, 0));
  EXPECT_EQ(closest_on_triangle({1, 1, 0}, kA, kB, kC), DVec3(0.5, 0.5, 0));
}

TEST(ClosestOnTriangle, OfDegenerateTriangles) {
  EXPECT_EQ(closest_on_triangle({1, 1, 1}, kB, kB, kB), kB);
  EXPECT_EQ(closest_on_triangle({0.5, 1, 0}, kA, kA, kB), DVec3(0.5, 0, 0));
  // Three points on a line, in every order.
  const DVec3 p(1.5, 2, 0), far(2, 0, 0);
  EXPECT_EQ(closest_on_triangle(p, kA, kB, far), DVec3(1.5, 0, 0));
  EXPECT_EQ(closest_on_triangle(p, kA, far, kB), DVec3(1.5, 0, 0));
  EXPECT_EQ(closest_on_triangle(p, far, kA, kB), DVec3(1.5, 0, 0));
}

TEST(ClosestOnTriangle, AgreesWithADenseSearch) {
  Random random(11);
  const auto point = [&] {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    return 2.0 * DVec3(x, y, z) - 1.0;
  };
  for (int i = 0; i < 200; ++i) {
    const DVec3 a = point(), b = point(), c = point(), p = 2.0 * point();
    const double found = glm::length(closest_on_triangle(p, a, b, c) - p);
    double best = 1e9;
    const int n = 60;
    for (int u = 0; u <= n; ++u)
      for (int v = 0; u + v <= n; ++v) {
        const DVec3 q = a + (double(u) * (b - a) + double(v) * (c - a)) / double(n);
        best = std::min(best, glm::length(q - p));
      }
    ASSERT_LE(found, best + 1e-12);
    ASSERT_GE(found, best - 0.06);
  }
}

TEST(ClosestOnSegment, EndsAndMiddle) {
  EXPECT_EQ(closest_on_segment({-1, 2, 0}, kA, kB), kA);
  EXPECT_EQ(closest_on_segment({0.25, 2, 0}, kA, kB), DVec3(0.25, 0, 0));
  EXPECT_EQ(closest_on_segment({7, 2, 0}, kA, kB), kB);
  EXPECT_EQ(closest_on_segment({7, 2, 0}, kC, kC), kC);
}

}  // namespace
}  // namespace varifold
