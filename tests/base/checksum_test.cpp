#include <gtest/gtest.h>

#include <varifold/base/checksum.h>
#include <array>

namespace varifold {
namespace {

TEST(Checksum, OfNothingIsThatOfXxh3) { EXPECT_EQ(checksum({}), 0x2d06800538d394c2u); }

TEST(Checksum, EveryBitCounts) {
  std::array<std::byte, 33> bytes{};
  const std::uint64_t before = checksum(bytes);
  for (std::size_t i = 0; i < 8 * bytes.size(); ++i) {
    bytes[i / 8] ^= std::byte{1} << (i % 8);
    EXPECT_NE(checksum(bytes), before);
    bytes[i / 8] ^= std::byte{1} << (i % 8);
  }
  EXPECT_EQ(checksum(bytes), before);
}

}  // namespace
}  // namespace varifold
