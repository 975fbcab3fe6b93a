#include <varifold/simplify/sample_blocks.h>

#include <gtest/gtest.h>
#include <varifold/base/random.h>
#include <vector>

namespace varifold {
namespace {

EnergySample sample_of(std::uint32_t number) {
  return {Vec3(static_cast<float>(number)), static_cast<float>(number), number};
}

TEST(SampleBlocks, HoldsWhatVectorsHold) {
  constexpr std::uint32_t kOwners = 20;
  SampleBlocks blocks(kOwners);
  std::vector<std::vector<std::uint32_t>> expected(kOwners);
  Random random(2);
  for (std::uint32_t i = 0; i < 30000; ++i) {
    const std::uint32_t owner = random.below(kOwners);
    if (random.below(50) == 0) {
      blocks.clear(owner);
      expected[owner].clear();
    } else {
      blocks.add(owner, sample_of(i));
      expected[owner].push_back(i);
    }
    if (random.below(20) == 0) blocks.tidy();
    const auto samples = blocks.of(owner);
    ASSERT_EQ(samples.size(), expected[owner].size());
    for (std::size_t k = 0; k < samples.size(); ++k)
      ASSERT_EQ(samples[k].attributes, expected[owner][k]);
  }
}

// As in a simplification: all samples end with few owners.
TEST(SampleBlocks, TidyingBoundsMemory) {
  constexpr std::uint32_t kOwners = 1 << 15;
  SampleBlocks blocks(kOwners);
  for (std::uint32_t i = 0; i < kOwners; ++i) blocks.add(i, sample_of(i));
  std::size_t greatest = 0;
  for (std::uint32_t step = 1; step < kOwners; step *= 2)
    for (std::uint32_t owner = 0; owner < kOwners; owner += 2 * step) {
      const auto moved = blocks.of(owner + step);
      const std::vector<EnergySample> samples(moved.begin(), moved.end());
      blocks.clear(owner + step);
      for (const EnergySample& sample : samples) blocks.add(owner, sample);
      blocks.tidy();
      greatest = std::max(greatest, blocks.bytes());
    }
  EXPECT_EQ(blocks.of(0).size(), kOwners);
  EXPECT_LT(greatest, 8 * kOwners * sizeof(EnergySample) + (1 << 19));
}

// Tidying moves all samples, so it has to be worth it: once more at once it does nothing.
template <std::uint32_t kSmallest>
void expect_tidy_once() {
  SamplesOfOwners<EnergySample, kSmallest> blocks(1 << 15);
  for (std::uint32_t i = 0; i < 1 << 15; ++i) blocks.add(i, sample_of(i));
  for (std::uint32_t i = 1; i < 1 << 15; ++i) {
    blocks.tidy();
    const EnergySample* const before = blocks.of(0).data();
    blocks.tidy();
    ASSERT_EQ(blocks.of(0).data(), before) << i;
    if (i % 3 == 0) blocks.clear(i);
  }
}
TEST(SampleBlocks, TidyingIsDoneOnce) {
  expect_tidy_once<1>();
  expect_tidy_once<4>();
}

}  // namespace
}  // namespace varifold
