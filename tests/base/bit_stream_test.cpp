#include <varifold/base/bit_stream.h>

#include <gtest/gtest.h>

#include <varifold/base/random.h>
#include <varifold/base/rice_code.h>

namespace varifold {
namespace {

TEST(BitStream, FirstBitIsTheLowestOfTheFirstByte) {
  BitWriter writer;
  writer.bits(1, 1);
  writer.bits(0b10, 2);
  writer.bits(0xabc, 12);
  EXPECT_EQ(writer.bit_count(), 15u);
  const std::vector<std::byte> bytes = writer.take();
  EXPECT_EQ(bytes, (std::vector<std::byte>{std::byte{0xe5}, std::byte{0x55}}));
  EXPECT_EQ(writer.bit_count(), 0u);
}

TEST(BitStream, ReadsWhatWasWritten) {
  Random random(1);
  BitWriter writer;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> numbers;  // value, count
  for (int i = 0; i < 20000; ++i) {
    const std::uint32_t count = 1 + static_cast<std::uint32_t>(random.next() >> (32 + i % 32)) / 2;
    numbers.emplace_back(random.below(count), count);
    writer.uniform(numbers.back().first, count);
    writer.bits(numbers.back().first, 32);
    writer.bits(5, static_cast<unsigned>(i % 4));
  }
  const std::size_t bits = writer.bit_count();
  const std::vector<std::byte> bytes = writer.take();
  BitReader reader(bytes);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    ASSERT_EQ(reader.uniform(numbers[i].second), numbers[i].first);
    ASSERT_EQ(reader.bits(32), numbers[i].first);
    ASSERT_EQ(reader.bits(static_cast<unsigned>(i % 4)), 5u & ((1u << (i % 4)) - 1));
  }
  EXPECT_EQ(reader.position(), bits);
  EXPECT_FALSE(reader.exhausted());
  EXPECT_EQ(reader.bits(32), 0u);
  EXPECT_TRUE(reader.exhausted());
}

TEST(BitStream, UniformTakesTheLogarithm) {
  for (const std::uint32_t count : {1u, 2u, 3u, 5u, 64u, 100u, 0xffffffffu}) {
    for (const std::uint32_t value : {0u, count / 2, count - 1}) {
      BitWriter writer;
      writer.uniform(value, count);
      EXPECT_LE(writer.bit_count(), static_cast<std::size_t>(std::bit_width(count - 1)));
      EXPECT_GE(writer.bit_count() + 1, static_cast<std::size_t>(std::bit_width(count)));
    }
  }
}

TEST(RiceCode, ReadsWhatWasWritten) {
  Random random(2);
  BitWriter writer;
  RiceModel model;
  std::vector<std::uint32_t> values{0, 0xffffffffu, 0xffffffffu, 0, 1};
  for (int i = 0; i < 5000; ++i)
    values.push_back(static_cast<std::uint32_t>(random.next() >> (32 + i / 200)));
  for (const std::uint32_t value : values) {
    model.write(value, writer);
    model.update(value);
  }
  const std::vector<std::byte> bytes = writer.take();
  BitReader reader(bytes);
  RiceModel other;
  for (const std::uint32_t value : values) {
    ASSERT_EQ(other.read(reader), value);
    other.update(value);
  }
  EXPECT_FALSE(reader.exhausted());
}

TEST(RiceCode, ComesNearTheEntropy) {
  Random random(3);
  BitWriter writer;
  RiceModel model(1000);
  for (int i = 0; i < 10000; ++i) {  // even over 64 values: six bits
    const std::uint32_t value = random.below(64);
    model.write(value, writer);
    model.update(value);
  }
  EXPECT_LT(writer.bit_count(), 10000u * 7);
}

TEST(RiceCode, ZigzagIsABijection) {
  EXPECT_EQ(zigzag(0), 0u);
  EXPECT_EQ(zigzag(0xffffffffu), 1u);
  EXPECT_EQ(zigzag(1), 2u);
  for (const std::uint32_t value : {0u, 1u, 5u, 0x7fffffffu, 0x80000000u, 0xffffffffu})
    EXPECT_EQ(unzigzag(zigzag(value)), value);
}

}  // namespace
}  // namespace varifold
