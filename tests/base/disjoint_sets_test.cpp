#include <gtest/gtest.h>

#include <varifold/base/disjoint_sets.h>

namespace varifold {
namespace {

TEST(DisjointSets, TheSmallestMemberStandsForItsSet) {
  DisjointSets sets(6);
  EXPECT_EQ(sets.set_count(), 6u);
  EXPECT_TRUE(sets.unite(5, 3));
  EXPECT_TRUE(sets.unite(4, 5));
  EXPECT_FALSE(sets.unite(3, 4));
  EXPECT_EQ(sets.find(5), 3u);
  EXPECT_TRUE(sets.unite(5, 1));
  EXPECT_EQ(sets.find(4), 1u);
  EXPECT_EQ(sets.find(0), 0u);
  EXPECT_EQ(sets.set_count(), 3u);
  sets.reset(2);
  EXPECT_EQ(sets.size(), 2u);
  EXPECT_EQ(sets.find(1), 1u);
}

}  // namespace
}  // namespace varifold
