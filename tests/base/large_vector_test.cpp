#include <gtest/gtest.h>

#include <varifold/base/large_vector.h>
#include <cstdint>
#include <limits>
#include <new>
#include <numeric>

namespace varifold {
namespace {

TEST(LargeVector, IsAlignedAndKeepsItsContents) {
  for (const std::size_t bytes : {0u, 1u, 63u, 64u, 5000u, (4u << 20) - 1, 4u << 20, (4u << 20) + 1,
                                  (6u << 20) - 1, 6u << 20, 9'999'999u}) {
    LargeVector<std::uint8_t> vector(bytes, 7);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(vector.data()) % 64, 0u);
    EXPECT_EQ(std::accumulate(vector.begin(), vector.end(), std::size_t{0}), 7 * bytes);
  }
}

TEST(LargeVector, GrowsAndMoves) {
  LargeVector<std::uint32_t> vector;
  for (std::uint32_t i = 0; i < 3'000'000; ++i) vector.push_back(i);
  LargeVector<std::uint32_t> other = vector;
  vector.clear();
  vector.shrink_to_fit();
  for (std::uint32_t i = 0; i < 3'000'000; ++i) ASSERT_EQ(other[i], i);
}

TEST(LargeVector, MoreThanThereIsThrows) {
  EXPECT_THROW((void)allocate_large(std::numeric_limits<std::size_t>::max() - 1), std::bad_alloc);
  EXPECT_THROW((void)allocate_large(std::numeric_limits<std::size_t>::max() / 4), std::bad_alloc);
}

}  // namespace
}  // namespace varifold
