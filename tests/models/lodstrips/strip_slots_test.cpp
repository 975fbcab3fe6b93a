#include <gtest/gtest.h>
#include <varifold/base/random.h>
#include <varifold/models/lodstrips/strip_slots.h>
#include <utility>
#include <vector>

namespace varifold {
namespace {

TriangleStrips two_strips() {
  TriangleStrips strips;
  strips.indices = {0, 1, 2, 3, 4, 5, 6};
  strips.end_strip(0);
  strips.indices.insert(strips.indices.end(), {7, 8, 9, 10});
  strips.end_strip(0);
  return strips;
}

TEST(StripSlots, PairsGoBehindTheEndAndComeBack) {
  const TriangleStrips strips = two_strips();
  StripSlots slots(strips);
  slots.remove(0, 1);
  EXPECT_EQ(slots.indices(), (std::vector<std::uint32_t>{0, 3, 4, 5, 6, 1, 2, 7, 8, 9, 10}));
  EXPECT_EQ(slots.length(0), 5u);
  slots.remove(0, 3);
  EXPECT_EQ(slots.indices(), (std::vector<std::uint32_t>{0, 3, 4, 5, 6, 1, 2, 7, 8, 9, 10}));
  EXPECT_EQ(slots.length(0), 3u);
  slots.remove(0, 3);  // the last index alone
  EXPECT_EQ(slots.length(0), 2u);
  slots.remove(0, 0);
  EXPECT_EQ(slots.length(0), 0u);
  EXPECT_FALSE(slots.can_remove(0, 0));
  EXPECT_EQ(slots.length(1), 4u);
  for (const std::uint32_t position : {0u, 3u, 3u, 1u}) slots.restore(0, position);
  EXPECT_EQ(slots.indices(), strips.indices);
  EXPECT_EQ(slots.length(0), 7u);
}

TEST(StripSlots, AnyRemovalsAreUndone) {
  Random random(3);
  for (int run = 0; run < 200; ++run) {
    TriangleStrips strips;
    for (std::uint32_t i = 0; i < 3 + random.below(40); ++i) strips.indices.push_back(i);
    strips.end_strip(0);
    StripSlots slots(strips);
    std::vector<std::uint32_t> done;
    std::vector<std::vector<std::uint32_t>> before;
    while (slots.length(0) > 2) {
      const std::uint32_t position = random.below(slots.length(0) + 1);
      if (!slots.can_remove(0, position)) continue;
      before.push_back(slots.indices());
      done.push_back(position);
      slots.remove(0, position);
    }
    while (!done.empty()) {
      slots.restore(0, done.back());
      ASSERT_EQ(slots.indices(), before.back());
      done.pop_back();
      before.pop_back();
    }
    EXPECT_EQ(slots.length(0), strips.indices.size());
  }
}

}  // namespace
}  // namespace varifold
