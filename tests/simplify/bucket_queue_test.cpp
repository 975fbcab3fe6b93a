#include <varifold/simplify/bucket_queue.h>

#include <gtest/gtest.h>
#include <varifold/base/random.h>
#include <algorithm>
#include <set>

namespace varifold {
namespace {

struct NoPrefetch {
  void later(std::uint32_t) const {}
  void soon(std::uint32_t) const {}
};

constexpr std::uint32_t kAll = BucketQueue::kBucketCount;

TEST(BucketQueue, IsOrderedToSixBitsOfMantissa) {
  Random random(3);
  std::vector<float> cost(5000);
  BucketQueue queue;
  for (std::uint32_t v = 0; v < cost.size(); ++v) {
    cost[v] = static_cast<float>(random.uniform() * random.uniform() * 1e-3);
    queue.push(v, BucketQueue::bucket_of(cost[v]));
  }
  EXPECT_EQ(queue.size(), cost.size());
  float greatest = 0;
  std::set<std::uint32_t> seen;
  for (std::uint32_t v = queue.pop(kAll, NoPrefetch{}); v != kNone;
       v = queue.pop(kAll, NoPrefetch{})) {
    EXPECT_GE(cost[v] * (1 + 1.0f / 64), greatest);
    greatest = std::max(greatest, cost[v]);
    EXPECT_TRUE(seen.insert(v).second);
  }
  EXPECT_EQ(seen.size(), cost.size());
}

TEST(BucketQueue, StopsAtTheLimit) {
  BucketQueue queue;
  queue.push(1, BucketQueue::bucket_of(1.0f));
  queue.push(2, BucketQueue::bucket_of(2.0f));
  const std::uint32_t limit = BucketQueue::bucket_of(2.0f);
  EXPECT_EQ(queue.pop(limit, NoPrefetch{}), 1u);
  EXPECT_EQ(queue.pop(limit, NoPrefetch{}), kNone);
  EXPECT_EQ(queue.lowest(), limit);
  EXPECT_EQ(queue.pop(limit + 1, NoPrefetch{}), 2u);
  EXPECT_EQ(queue.lowest(), kAll);
}

TEST(BucketQueue, NeverGoesBack) {
  BucketQueue queue;
  queue.push(1, 100);
  EXPECT_EQ(queue.pop(kAll, NoPrefetch{}), 1u);
  queue.push(2, 50);
  queue.push(3, 101);
  EXPECT_EQ(queue.pop(kAll, NoPrefetch{}), 2u);
  EXPECT_EQ(queue.current(), 100u);
  EXPECT_EQ(queue.pop(kAll, NoPrefetch{}), 3u);
}

TEST(BucketQueue, TakesAnother) {
  BucketQueue a, b;
  for (std::uint32_t v = 0; v < 100; ++v) (v % 2 ? a : b).push(v, v / 10);
  a.take(b);
  EXPECT_EQ(b.size(), 0u);
  EXPECT_EQ(a.size(), 100u);
  std::uint32_t last = 0;
  for (std::uint32_t v = a.pop(kAll, NoPrefetch{}); v != kNone; v = a.pop(kAll, NoPrefetch{})) {
    EXPECT_GE(v / 10, last);
    last = v / 10;
  }
}

TEST(BucketQueue, NamesWhatComesUpNext) {
  struct Recorder {
    std::vector<std::uint32_t>& soon_list;
    void later(std::uint32_t) const {}
    void soon(std::uint32_t v) const { soon_list.push_back(v); }
  };
  BucketQueue queue;
  for (std::uint32_t v = 0; v < 60; ++v) queue.push(v, 7);
  std::vector<std::uint32_t> soon, popped;
  for (std::uint32_t v = queue.pop(kAll, Recorder{soon}); v != kNone;
       v = queue.pop(kAll, Recorder{soon}))
    popped.push_back(v);
  ASSERT_EQ(soon.size() + 3, popped.size());
  for (std::size_t i = 0; i < soon.size(); ++i) EXPECT_EQ(soon[i], popped[i + 3]);
}

}  // namespace
}  // namespace varifold
