// Numbers in as many bytes as they need, seven bits in each, the lowest first; all bytes but the
// last have the highest bit set.
#pragma once

#include <varifold/models/common/section_reader.h>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

inline void append_varint(std::vector<std::byte>& bytes, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) bytes.push_back(static_cast<std::byte>(value | 0x80));
  bytes.push_back(static_cast<std::byte>(value));
}

/// Below 2^63; section.good() is false afterwards where it is not, or not there.
[[nodiscard]] inline std::uint64_t take_varint(SectionReader& section) {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 63; shift += 7) {
    const auto byte = section.take<std::uint8_t>();
    value |= std::uint64_t{byte & 0x7fu} << shift;
    if (byte < 0x80) return value;
  }
  section.fail_here();
  return 0;
}

/// Small for numbers near zero: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
[[nodiscard]] inline std::uint64_t to_zigzag(std::int64_t value) {
  return (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63);
}
[[nodiscard]] inline std::int64_t from_zigzag(std::uint64_t code) {
  return static_cast<std::int64_t>(code >> 1) ^ -static_cast<std::int64_t>(code & 1);
}

}  // namespace varifold
