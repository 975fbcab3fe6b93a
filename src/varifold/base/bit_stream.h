// Numbers of any width in a stream of bits: the first bit is the lowest of the first byte.
#pragma once

#include <varifold/base/bytes.h>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace varifold {

/// Appends numbers to a byte buffer.
class BitWriter {
 public:
  /// The lowest `count` bits of `value`; count <= 32.
  void bits(std::uint32_t value, unsigned count) {
    window_ |= (std::uint64_t{value} & ((std::uint64_t{1} << count) - 1)) << filled_;
    for (filled_ += count; filled_ >= 8; filled_ -= 8, window_ >>= 8)
      bytes_.push_back(static_cast<std::byte>(window_ & 0xff));
  }
  /// A number in [0, count) whose values are all as likely: log2(count) bits, at most one more for
  /// some of them (truncated binary code). count > 0.
  void uniform(std::uint32_t value, std::uint32_t count) {
    const auto width = static_cast<unsigned>(std::bit_width(count >> 1));
    const std::uint32_t longer = count - (1u << width);  // so many prefixes have one bit more
    bits(value % (1u << width), width);
    const std::uint32_t prefix = value & ((1u << width) - 1);
    if (prefix < longer) bits(value >> width, 1);
  }

  [[nodiscard]] std::size_t bit_count() const { return 8 * bytes_.size() + filled_; }
  /// The bytes so far, the last one filled up with zeros. The writer begins anew.
  [[nodiscard]] std::vector<std::byte> take() {
    if (filled_ > 0) bytes_.push_back(static_cast<std::byte>(window_ & 0xff));
    window_ = 0;
    filled_ = 0;
    return std::exchange(bytes_, {});
  }

 private:
  std::vector<std::byte> bytes_;
  std::uint64_t window_ = 0;
  unsigned filled_ = 0;  // bits of the window, below 8
};

/// Reads what BitWriter wrote. Beyond the end there are zeros: read as much as a number of records
/// needs, then ask exhausted() once.
class BitReader {
 public:
  explicit BitReader(std::span<const std::byte> bytes, std::size_t first_bit = 0)
      : bytes_(bytes), position_(first_bit) {}

  /// The next 57 bits or more, without taking them.
  [[nodiscard]] std::uint64_t peek() const {
    const std::size_t at = position_ >> 3;
    const auto skip = static_cast<unsigned>(position_ & 7);
    if (at + 8 <= bytes_.size()) return load<std::uint64_t>(bytes_.data() + at) >> skip;
    std::uint64_t window = 0;
    for (std::size_t i = at; i < bytes_.size(); ++i)
      window |= std::to_integer<std::uint64_t>(bytes_[i]) << (8 * (i - at));
    return window >> skip;
  }
  void skip(unsigned count) { position_ += count; }

  /// count <= 32.
  std::uint32_t bits(unsigned count) {
    const std::uint64_t window = peek();
    skip(count);
    return static_cast<std::uint32_t>(window & ((std::uint64_t{1} << count) - 1));
  }
  /// count > 0; the result is below it.
  std::uint32_t uniform(std::uint32_t count) {
    const auto width = static_cast<unsigned>(std::bit_width(count >> 1));
    const std::uint32_t longer = count - (1u << width);
    const std::uint64_t window = peek();
    const auto prefix = static_cast<std::uint32_t>(window & ((std::uint64_t{1} << width) - 1));
    if (prefix >= longer) {
      skip(width);
      return prefix;
    }
    skip(width + 1);
    return prefix | static_cast<std::uint32_t>((window >> width) & 1) << width;
  }

  /// In bits from the start of the span; may lie beyond its end.
  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] bool exhausted() const { return position_ > 8 * bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t position_;
};

}  // namespace varifold
