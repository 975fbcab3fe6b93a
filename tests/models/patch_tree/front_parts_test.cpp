// What fronts are made of: required nodes, priorities of many nodes at once, the queue.
#include <tests/models/patch_tree/front_oracle.h>

#include <gtest/gtest.h>

#include <varifold/models/patch_tree/front_lanes.h>
#include <algorithm>
#include <bit>
#include <set>

namespace varifold::test {
namespace {

//  level 0   0 | 1 | 2      patches in a row, each a neighbour of the next
//  level 1   3 4 | 5 | 6 7
TEST(RequiredNodes, AreTheOwnParentAndThoseOfNeighbours) {
  LeafPatches leaves;
  leaves.centers.assign(8, Vec3(0));
  leaves.normals.assign(8, Vec3(0, 0, 1));
  leaves.neighbors = {{1}, {0, 2}, {1, 3}, {2, 4}, {3, 5}, {4, 6}, {5, 7}, {6}};
  const PatchTree tree = make_tree(leaves, {{0, 0, 1, 1, 2, 3, 3, 4}, {0, 0, 1, 2, 2}}, {});
  const RequiredNodes required(tree.topology());
  const auto of = [&](std::uint32_t node) {
    return std::vector<std::uint32_t>(required.of(node).begin(), required.of(node).end());
  };
  using Nodes = std::vector<std::uint32_t>;
  EXPECT_EQ(inner_node_count(tree.topology()), 8u);
  EXPECT_EQ(of(1), Nodes{});
  EXPECT_EQ(of(3), Nodes{0});
  EXPECT_EQ(of(4), (Nodes{0, 1}));
  EXPECT_EQ(of(5), (Nodes{1, 0, 2}));
  EXPECT_EQ(of(7), Nodes{2});
}

TEST(FrontPriorities, OfManyNodesAreThoseOfEachToTheBit) {
  Random random(41);
  int wide = 0, hidden = 0;
  for (const NamedTree& named : small_trees()) {
    SCOPED_TRACE(named.name);
    const FrontTables tables(named.tree);
    std::vector<std::uint64_t> all(tables.word_count());
    for (std::uint32_t node = 0; node < tables.inner_count(); ++node)
      all[node / 64] |= 1ull << node % 64;
    const std::vector<std::uint64_t> words((tables.word_count() + 63) / 64,
                                           ~0ull >> (64 - std::max(1u, tables.word_count())));
    std::vector<float> many(tables.no_parent() + 1), narrow(many);
    for (std::uint32_t i = 0; i < 40; ++i) {
      RefineCriteria criteria;
      criteria.view.emplace(random_camera(random));
      criteria.view->outside_weight = (i & 1u) != 0 ? 1 : 0;
      criteria.view->back_weight = (i & 2u) != 0 ? 1 : 0;
      const auto measure = (i & 4u) != 0 ? PatchMeasure::kMeanSquared : PatchMeasure::kPixels;
      FrontPriorities priorities;
      EXPECT_TRUE(priorities.set(criteria, measure));
      EXPECT_FALSE(priorities.set(criteria, measure));
      priorities.evaluate({tables, words, all, many});
      const auto expected = oracle_priorities(*named.tree, criteria, measure);
      front_lanes::Numbers numbers;
      numbers.eye_x = criteria.view->eye.x;
      numbers.eye_y = criteria.view->eye.y;
      numbers.eye_z = criteria.view->eye.z;
      numbers.focal = criteria.view->scale.focal_pixels();
      numbers.near_distance = criteria.view->scale.near_distance();
      for (std::size_t p = 0; p < criteria.view->frustum.planes.size(); ++p) {
        const Plane& plane = criteria.view->frustum.planes[p];
        numbers.planes[p] = {plane.normal.x, plane.normal.y, plane.normal.z, plane.offset};
      }
      narrow.back() = HUGE_VALF;
      const auto parts = static_cast<std::uint8_t>(((i & 4u) != 0 ? front_lanes::kMeanSquares : 0) +
                                                   ((i & 1u) != 0 ? 0 : front_lanes::kCulls) +
                                                   ((i & 2u) != 0 ? 0 : front_lanes::kTurns));
      front_lanes::plain_functions_of(parts).evaluate(numbers, {tables, words, all, narrow});
      for (std::uint32_t node = 0; node < tables.inner_count(); ++node) {
        const std::uint32_t parent = tables.topology().parent[node];
        const float limit = parent == kNone ? HUGE_VALF : expected[parent];
        ASSERT_EQ(std::bit_cast<std::uint32_t>(many[node]),
                  std::bit_cast<std::uint32_t>(expected[node]));
        ASSERT_EQ(narrow[node], expected[node]);
        ASSERT_EQ(priorities.evaluate_singly(named.tree->data().bounds[node], limit),
                  expected[node]);
        ASSERT_LE(many[node], limit);
        wide += many[node] > 0 ? 1 : 0;
        hidden += many[node] == 0 ? 1 : 0;
      }
      for (std::uint32_t node = 0; node < tables.inner_count(); ++node) {
        const std::uint32_t first = tables.topology().first_child[node];
        const std::uint32_t end = tables.topology().first_child[node + 1];
        if (first >= tables.inner_count()) continue;
        std::vector<float> some(tables.no_parent() + 1, -1);
        priorities.evaluate_children(tables, first, end - first, expected[node], some);
        for (std::uint32_t n = 0; n < some.size(); ++n)
          ASSERT_EQ(some[n], n >= first && n < end ? expected[n] : -1);
      }
    }
  }
  EXPECT_GT(wide, 1000);
  EXPECT_GT(hidden, 1000);
}

TEST(FrontScan, FindsWhatIsWithin) {
  Random random(47);
  std::vector<float> priorities(64);
  for (int round = 0; round < 500; ++round) {
    for (float& p : priorities) p = random.below(9) == 0 ? HUGE_VALF : 0.1f * random.below(10);
    std::uint64_t nodes = random.next();
    if (round % 3 == 0) nodes &= 0xff0000ff00ff0000ull;
    const front_scan::Window window{0.1f * random.below(10),
                                    round % 2 == 0 ? HUGE_VALF : 0.1f * random.below(10)};
    std::uint64_t expected = 0;
    for (std::uint32_t i = 0; i < 64; ++i)
      if ((nodes >> i & 1u) != 0 && priorities[i] > window.above && priorities[i] <= window.up_to)
        expected |= 1ull << i;
    ASSERT_EQ(front_scan::word_within(nodes, priorities.data(), window), expected);
    ASSERT_EQ(front_scan::word_within_plain(nodes, priorities.data(), window), expected);
  }
}

TEST(FrontQueue, GivesTheGreatestFirst) {
  Random random(43);
  FrontQueue queue(4000);
  for (int round = 0; round < 20; ++round) {
    std::set<FrontKey> expected;
    const auto push = [&](std::uint32_t node, float priority) {
      queue.push(priority, node);
      expected.insert(front_key(priority, node));
    };
    const float ladder[] = {0, 1e-40f, 1, 1, 1.001f, 3e38f, HUGE_VALF};
    for (std::uint32_t node = 0; node < 2000; ++node)
      push(node, random.below(3) == 0 ? ladder[random.below(7)]
                                      : static_cast<float>(std::exp(9 * random.uniform())));
    std::uint32_t next = 2000;
    std::uint32_t taken = 0;
    const std::uint32_t last = round % 2 == 0 ? kNone : random.below(3000);
    while (!expected.empty() && taken < last) {
      ASSERT_EQ(queue.size(), expected.size());
      const FrontKey key = *expected.rbegin();
      expected.erase(key);
      ASSERT_EQ(queue.pop(), node_of(key));
      ++taken;
      // Children: not above.
      const float priority = std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32u));
      if (next < 4000 && random.below(2) == 0)
        push(next++, random.below(4) == 0
                         ? priority
                         : std::min(priority, 3e38f) * static_cast<float>(random.uniform()));
    }
    EXPECT_EQ(queue.empty(), expected.empty());
    queue.clear();
    EXPECT_TRUE(queue.empty());
  }
}

}  // namespace
}  // namespace varifold::test
