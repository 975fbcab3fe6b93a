#include <gtest/gtest.h>

#include <varifold/base/random.h>
#include <varifold/mesh/weld.h>
#include <cmath>
#include <limits>

namespace varifold {
namespace {

using Classes = std::vector<std::uint32_t>;

TEST(WeldExact, NothingOfNothing) {
  const WeldMap weld = weld_exact({});
  EXPECT_TRUE(weld.class_of.empty());
  EXPECT_EQ(weld.class_count, 0u);
}

TEST(WeldExact, NumbersClassesByFirstVertex) {
  const std::vector<Vec3> p{{5, 0, 0}, {1, 2, 3}, {5, 0, 0}, {4, 4, 4}, {1, 2, 3}, {5, 0, 0}};
  const WeldMap weld = weld_exact(p);
  EXPECT_EQ(weld.class_of, (Classes{0, 1, 0, 2, 1, 0}));
  EXPECT_EQ(weld.class_count, 3u);
}

TEST(WeldExact, MinusZeroIsZero) {
  const std::vector<Vec3> p{{0.0f, -0.0f, 1}, {-0.0f, 0.0f, 1}, {0, 0, -1}};
  EXPECT_EQ(weld_exact(p).class_of, (Classes{0, 0, 1}));
}

TEST(WeldExact, NeighbouringFloatsAreApart) {
  const std::vector<Vec3> p{{1, 1, 1}, {std::nextafter(1.0f, 2.0f), 1, 1}, {1, 1, 1}};
  EXPECT_EQ(weld_exact(p).class_of, (Classes{0, 1, 0}));
}

TEST(WeldExact, SwappedCoordinatesAreApart) {
  const std::vector<Vec3> p{{1, 2, 3}, {2, 1, 3}, {3, 2, 1}, {1, 3, 2}};
  EXPECT_EQ(weld_exact(p).class_count, 4u);
}

TEST(WeldExact, AgreesWithBruteForceOnALattice) {
  Random random(7);
  std::vector<Vec3> p(2000);
  for (Vec3& x : p) x = Vec3(random.below(10), random.below(10), random.below(10)) * 0.1f;
  const WeldMap weld = weld_exact(p);
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    std::size_t first = 0;
    while (p[first] != p[i]) ++first;
    if (first == i) {
      EXPECT_EQ(weld.class_of[i], count);
      ++count;
    } else {
      EXPECT_EQ(weld.class_of[i], weld.class_of[first]);
    }
  }
  EXPECT_EQ(weld.class_count, count);
}

TEST(WeldWithin, ZeroToleranceIsExact) {
  const std::vector<Vec3> p{{0, 0, 0}, {1e-30f, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(weld_within(p, 0).class_of, weld_exact(p).class_of);
}

TEST(WeldWithin, JoinsChains) {
  // Links of 0.9, 0.9 and 1.2: only the first three are one point at tolerance 1.
  const std::vector<Vec3> p{{1.8f, 0, 0}, {3, 0, 0}, {0, 0, 0}, {0.9f, 0, 0}};
  const WeldMap weld = weld_within(p, 1);
  EXPECT_EQ(weld.class_of, (Classes{0, 1, 0, 0}));
  EXPECT_EQ(weld.class_count, 2u);
}

TEST(WeldWithin, LinksOfExactlyTheToleranceAndNegativeCells) {
  const std::vector<Vec3> p{{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.75f, 0}};
  EXPECT_EQ(weld_within(p, 1).class_of, (Classes{0, 0, 1}));
}

TEST(WeldWithin, AgreesWithBruteForce) {
  Random random(3);
  std::vector<Vec3> p(600);
  for (Vec3& x : p)
    x = 10.0f * Vec3(static_cast<float>(random.uniform()), static_cast<float>(random.uniform()),
                     static_cast<float>(random.uniform())) -
        5.0f;
  const float tolerance = 0.6f;
  const WeldMap weld = weld_within(p, tolerance);
  // Flood from every point over links, in order of the first vertex.
  Classes expected(p.size(), kNone);
  std::uint32_t count = 0;
  for (std::uint32_t seed = 0; seed < p.size(); ++seed) {
    if (expected[seed] != kNone) continue;
    Classes stack{seed};
    expected[seed] = count;
    while (!stack.empty()) {
      const std::uint32_t v = stack.back();
      stack.pop_back();
      for (std::uint32_t w = 0; w < p.size(); ++w) {
        if (expected[w] != kNone || glm::length(DVec3(p[v]) - DVec3(p[w])) > double(tolerance))
          continue;
        expected[w] = count;
        stack.push_back(w);
      }
    }
    ++count;
  }
  EXPECT_GT(count, 10u);
  EXPECT_EQ(weld.class_count, count);
  EXPECT_EQ(weld.class_of, expected);
}

TEST(WeldWithin, HugeAndNonFiniteCoordinatesStayApart) {
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Vec3> p{{3e38f, 0, 0}, {-3e38f, 0, 0}, {inf, 0, 0}, {nan, 0, 0}, {3e38f, 0, 0}};
  EXPECT_EQ(weld_within(p, 1e-30f).class_of, (Classes{0, 1, 2, 3, 0}));
}

}  // namespace
}  // namespace varifold
