#include <varifold/simplify/cost_heap.h>

#include <gtest/gtest.h>
#include <varifold/base/random.h>
#include <set>
#include <utility>

namespace varifold {
namespace {

// Against an ordered set, with costs that are often equal, negative, and change both ways.
TEST(CostHeap, GivesTheLeastCostThenTheLowestPoint) {
  constexpr std::uint32_t kPoints = 60;
  CostHeap heap(kPoints);
  std::set<std::pair<float, std::uint32_t>> expected;
  std::vector<float> cost(kPoints, 0);
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const std::uint32_t point = random.below(kPoints);
    if (heap.contains(point)) expected.erase({cost[point], point});
    if (random.below(3) == 0) {
      heap.remove(point);
    } else {
      cost[point] = static_cast<float>(random.below(9)) - 4;
      heap.set(point, cost[point]);
      expected.insert({cost[point], point});
    }
    ASSERT_EQ(heap.size(), expected.size());
    if (expected.empty()) continue;
    ASSERT_EQ(heap.top(), expected.begin()->second);
    ASSERT_EQ(heap.top_cost(), expected.begin()->first);
  }
}

}  // namespace
}  // namespace varifold
