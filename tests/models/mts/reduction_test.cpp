#include <gtest/gtest.h>

#include <varifold/base/random.h>
#include <varifold/models/mts/strip_reduction.h>
#include <varifold/strip/triangle_strips.h>
#include <algorithm>

namespace varifold::mts {
namespace {

using Indices = std::vector<std::uint32_t>;
constexpr std::uint32_t kCut = kStripRestart;

Indices reduced(const Indices& indices) {
  std::vector<StripItem> items;
  for (const std::uint32_t v : indices) items.push_back({v, kNone});
  StripReducer().reduce(items);
  Indices result;
  for (const StripItem& item : items) result.push_back(item.vertex);
  return result;
}

// Oriented triangles that are not degenerate, sorted.
std::vector<std::array<std::uint32_t, 3>> triangles(const Indices& indices) {
  std::vector<std::array<std::uint32_t, 3>> found;
  for (std::size_t begin = 0, i = 0; i < indices.size(); ++i) {
    if (indices[i] == kCut) begin = i + 1;
    if (i < begin + 2) continue;
    auto corners = strip_triangle(std::span(indices).subspan(begin), i - begin - 2);
    if (is_degenerate(corners)) continue;
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    found.push_back(corners);
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(MtsReduction, RunsInTheMiddleGoInPairs) {
  EXPECT_EQ(reduced({6, 5, 4, 7, 8, 8, 8, 9, 10}), (Indices{6, 5, 4, 7, 8, 8, 8, 9, 10}));
  EXPECT_EQ(reduced({1, 2, 3, 4, 4, 4, 4, 5, 6}), (Indices{1, 2, 3, 4, 4, 5, 6}));
  EXPECT_EQ(reduced({1, 2, 3, 4, 3, 4, 5, 6}), (Indices{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(reduced({1, 2, 3, 3, 4, 3, 3, 5, 6}), (Indices{1, 2, 3, 3, 3, 5, 6}));
}

TEST(MtsReduction, EndsThatDrawNothingGo) {
  EXPECT_EQ(reduced({1, 2, 3, 3}), (Indices{1, 2, 3}));
  EXPECT_EQ(reduced({1, 1, 1, 2, 3}), (Indices{1, 2, 3}));
  EXPECT_EQ(reduced({1, 1, 2, 3, 4}), (Indices{1, 1, 2, 3, 4}));
  EXPECT_EQ(reduced({1, 1, 2, 3}), (Indices{2, 1, 3}));
  EXPECT_EQ(reduced({1, 2, 1, 2, 2}), Indices{});
  EXPECT_EQ(reduced({}), Indices{});
}

TEST(MtsReduction, LongRunsBreak) {
  EXPECT_EQ(reduced({1, 2, 3, 3, 4, 4, 5, 5, 6, 7}), (Indices{1, 2, 3, kCut, 6, 5, 7}));
  const Indices broken = reduced({1, 2, 3, 4, 4, 9, 9, 5, 5, 6, 7, 8});
  EXPECT_EQ(std::count(broken.begin(), broken.end(), kCut), 1);
  EXPECT_LT(broken.size(), 12u);
}

// Random strips over few vertices, with restarts: the triangles stay, the length does not grow.
TEST(MtsReduction, KeepsTheTrianglesOfRandomStrips) {
  Random random(7);
  std::size_t before = 0, after = 0;
  for (int i = 0; i < 20000; ++i) {
    Indices strip(random.below(40));
    const std::uint32_t vertices = 2 + random.below(12);
    for (std::uint32_t& v : strip) v = random.below(12) == 0 ? kCut : random.below(vertices);
    const Indices result = reduced(strip);
    ASSERT_EQ(triangles(result), triangles(strip));
    ASSERT_LE(result.size(), strip.size());
    ASSERT_EQ(triangles(reduced(result)), triangles(strip));
    before += strip.size();
    after += result.size();
  }
  EXPECT_LT(after, before * 9 / 10);
}

TEST(MtsReduction, CutsATriangleOut) {
  Random random(8);
  int cuts = 0;
  for (int i = 0; i < 3000; ++i) {
    Indices strip(3 + random.below(12));
    for (std::uint32_t& v : strip) v = random.below(9);
    auto expected = triangles(strip);
    if (expected.empty()) continue;
    const auto chosen =
        expected.begin() + random.below(static_cast<std::uint32_t>(expected.size()));
    std::vector<StripItem> items;
    for (const std::uint32_t v : strip) items.push_back({v, kNone});
    ASSERT_TRUE(cut_triangle(*chosen, items));
    expected.erase(chosen);
    Indices left;
    for (const StripItem& item : items) left.push_back(item.vertex);
    ASSERT_EQ(triangles(left), expected);
    ++cuts;
    ASSERT_FALSE(cut_triangle({20, 21, 22}, items));
  }
  EXPECT_GT(cuts, 2000);
}

}  // namespace
}  // namespace varifold::mts
