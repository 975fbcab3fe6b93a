// Small numbers in few bits: Rice codes whose parameter follows the numbers.
//
// Based on: [Rice1979]; [WeinbergerSeroussiSapiro2000] section III-C (adapting the parameter).
// Differs: the mean is a running one, and very large numbers escape to 32 plain bits.
#pragma once

#include <varifold/base/bit_stream.h>
#include <bit>
#include <cstdint>

namespace varifold {

/// Signed as unsigned: 0, -1, 1, -2, 2, ... become 0, 1, 2, 3, 4, ...; modulo 2^32.
[[nodiscard]] inline std::uint32_t zigzag(std::uint32_t difference) {
  return (difference << 1) ^ (difference >> 31 ? ~0u : 0u);
}
[[nodiscard]] inline std::uint32_t unzigzag(std::uint32_t code) {
  return (code >> 1) ^ (code & 1 ? ~0u : 0u);
}

/// What writer and reader have learnt about the numbers of one kind. Both call update() with the
/// same numbers at the same places.
class RiceModel {
 public:
  explicit RiceModel(std::uint32_t expected = 0) : sum_(std::uint64_t{expected} * kMemory) {}

  void write(std::uint32_t value, BitWriter& bits) const {
    const unsigned width = low_bits();
    const std::uint32_t zeros = value >> width;
    if (zeros >= kEscape) {
      bits.bits(0, kEscape);
      bits.bits(value, 32);
      return;
    }
    bits.bits(1u << zeros, zeros + 1);
    bits.bits(value, width);
  }
  [[nodiscard]] std::uint32_t read(BitReader& bits) const {
    const unsigned width = low_bits();
    const std::uint64_t window = bits.peek();
    const auto zeros =
        static_cast<unsigned>(std::countr_zero(window | (std::uint64_t{1} << kEscape)));
    if (zeros == kEscape) {
      bits.skip(kEscape);
      return bits.bits(32);
    }
    bits.skip(zeros + 1 + width);
    const std::uint64_t low = (window >> (zeros + 1)) & ((std::uint64_t{1} << width) - 1);
    return static_cast<std::uint32_t>((std::uint64_t{zeros} << width) | low);
  }
  void update(std::uint32_t value) { sum_ += value - sum_ / kMemory; }

 private:
  static constexpr std::uint32_t kMemory = 16;
  static constexpr unsigned kEscape = 16;

  // The logarithm of the mean, rounded down, at most 31.
  [[nodiscard]] unsigned low_bits() const {
    const std::uint64_t mean = sum_ / kMemory;
    return mean == 0 ? 0 : static_cast<unsigned>(std::bit_width(mean)) - 1;
  }

  std::uint64_t sum_;  // kMemory times the running mean
};

}  // namespace varifold
