// The filter of degenerate triangles, and the pages that are drawn.
#include <gtest/gtest.h>
#include <tests/models/strips/strips_support.h>

#include <varifold/base/random.h>
#include <varifold/mesh/generators.h>
#include <varifold/models/common/strip_filter.h>
#include <varifold/models/strips/draw_pages.h>
#include <algorithm>

namespace varifold::test {
namespace {

using Strip = std::vector<std::uint32_t>;

Strip filtered(const Strip& strip) {
  Strip out(strip.size());
  out.resize(filter_strip(strip, out.data()));
  return out;
}

std::vector<Triangle> triangles_in(const Strip& strip) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
    const auto c = strip_triangle(strip, i);
    if (!is_degenerate(c)) triangles.push_back(turned(c[0], c[1], c[2], 0));
  }
  return triangles;
}

TEST(StripFilter, PairsGo) {
  // The example of the thesis, whose own result turns the last triangle over.
  EXPECT_EQ(filtered({6, 5, 4, 7, 8, 8, 8, 9, 10}), (Strip{6, 5, 4, 7, 8, 8, 8, 9, 10}));
  EXPECT_EQ(filtered({6, 5, 4, 7, 8, 8, 8, 8, 9, 10}), (Strip{6, 5, 4, 7, 8, 8, 9, 10}));
  EXPECT_EQ(filtered({6, 5, 4, 8, 8, 8, 8, 8, 9, 10}), (Strip{6, 5, 4, 8, 8, 8, 9, 10}));
  EXPECT_EQ(filtered({1, 2, 3, 4, 3, 4, 5}), (Strip{1, 2, 3, 4, 5}));
  EXPECT_EQ(filtered({1, 2, 3, 3, 4, 3, 3, 5, 6}), (Strip{1, 2, 3, 3, 3, 5, 6}));
  EXPECT_EQ(filtered({1, 2, 3, 4, 4, 4}), (Strip{1, 2, 3, 4}));
  EXPECT_EQ(filtered({1, 1, 1, 2, 3, 4}), (Strip{1, 2, 3, 4}) /* two from the beginning */);
  EXPECT_EQ(filtered({1, 1, 2, 3, 4, 5}), (Strip{1, 1, 2, 3, 4, 5}));
  EXPECT_EQ(filtered({1, 1, 2, 3, 4}), (Strip{1, 3, 2, 4}));
  EXPECT_EQ(filtered({1, 1, 2, 3}), (Strip{2, 1, 3}));
  EXPECT_EQ(filtered({1, 2, 1, 2, 1, 1, 2}), Strip{});
  EXPECT_EQ(filtered({1, 2}), Strip{});
  EXPECT_EQ(filtered({}), Strip{});
}

// All strips of up to eight indices out of three, and random ones: the triangles stay, in their
// order and orientation, and what is left cannot be filtered any further.
TEST(StripFilter, KeepsAllTriangles) {
  for (std::size_t length = 0; length <= 9; ++length) {
    std::size_t count = 1;
    for (std::size_t i = 0; i < length; ++i) count *= 3;
    for (std::size_t code = 0; code < count; ++code) {
      Strip strip(length);
      std::size_t rest = code;
      for (std::uint32_t& index : strip) {
        index = static_cast<std::uint32_t>(rest % 3);
        rest /= 3;
      }
      const Strip result = filtered(strip);
      ASSERT_EQ(triangles_in(result), triangles_in(strip));
      ASSERT_EQ(filtered(result), result);
      ASSERT_LE(result.size(), strip.size());
      ASSERT_EQ(result.empty(), triangles_in(strip).empty());
    }
  }
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    Strip strip(random.below(40));
    const std::uint32_t vertices = 1 + random.below(6);
    for (std::uint32_t& index : strip) index = random.below(vertices);
    const Strip result = filtered(strip);
    ASSERT_EQ(triangles_in(result), triangles_in(strip));
    ASSERT_EQ(filtered(result), result);
  }
}

// A copy of what a reader would have, kept up by the changed ranges alone.
TEST(StripsDraw, ChangedRangesCoverAllChanges) {
  Random random(2);
  const NamedFramework large =
      make_framework({"large", planet({{.triangles = 30000}, 0.12f, false})});
  std::vector<const NamedFramework*> models = small_frameworks(0xffffffffu);
  models.push_back(&large);
  for (const NamedFramework* named : models) {
    StripFrameworkInstance instance(named->model);
    const std::uint32_t finest = named->model->finest_level();
    std::vector<std::uint32_t> copy;
    for (int i = 0; i < 12; ++i) {
      const DrawList list = instance.draw_list();
      EXPECT_EQ(list.changed_vertices.empty(), i > 0 || list.positions.empty());
      if (i == 0)
        copy.assign(list.indices.begin(), list.indices.end());
      else
        for (const ElementRange& range : list.changed_indices)
          std::copy_n(list.indices.begin() + range.first, range.count, copy.begin() + range.first);
      ASSERT_TRUE(std::equal(copy.begin(), copy.end(), list.indices.begin())) << named->name;
      std::uint32_t end = 0;
      for (const DrawRange& range : list.ranges) {
        EXPECT_GE(range.first_index, end);
        EXPECT_GE(range.index_count, 3u);
        end = range.first_index + range.index_count;
        EXPECT_LE(end, list.indices.size());
      }
      EXPECT_EQ(triangle_set(list).size(), instance.triangle_count());
      EXPECT_TRUE(instance.draw_list().changed_indices.empty());
      if (i % 2 == 0) {  // a small step: few pages
        instance.go_to_level(instance.level() == kNone ? finest : instance.level() + 3);
        continue;
      }
      instance.go_to_level(random.below(finest + 1));
      if (i % 3 == 0) instance.adapt_by([&](std::uint32_t k) { return k % 97 == 0 ? 2.0f : 0.0f; });
    }
  }
  // Pages do their work: one step changes few of many.
  StripFrameworkInstance instance(large.model);
  instance.go_to_level(large.model->finest_level());
  ASSERT_GT(instance.draw_list().ranges.size(), 5u);
  instance.go_to_level(large.model->finest_level() - 1);
  EXPECT_LE(instance.draw_list().changed_indices.size(), 4u);
}

}  // namespace
}  // namespace varifold::test
