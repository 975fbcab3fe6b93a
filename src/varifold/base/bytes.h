// Numbers in byte buffers of either byte order, whatever the machine's own order and alignment.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

namespace varifold {

/// The value with its bytes in reverse order; for arithmetic types of 1, 2, 4 or 8 bytes.
template <class T>
[[nodiscard]] inline T reverse_bytes(T value) {
  if constexpr (sizeof(T) == 1) {
    return value;
  } else if constexpr (sizeof(T) == 2) {
    return std::bit_cast<T>(__builtin_bswap16(std::bit_cast<std::uint16_t>(value)));
  } else if constexpr (sizeof(T) == 4) {
    return std::bit_cast<T>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value)));
  } else {
    static_assert(sizeof(T) == 8);
    return std::bit_cast<T>(__builtin_bswap64(std::bit_cast<std::uint64_t>(value)));
  }
}

/// Loads a T that is stored in `kOrder` at any alignment; the caller guarantees sizeof(T) bytes.
template <class T, std::endian kOrder = std::endian::little>
[[nodiscard]] inline T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return kOrder == std::endian::native ? value : reverse_bytes(value);
}

/// Stores a T in little-endian order at any alignment.
template <class T>
inline void store_little(std::byte* to, T value) {
  if constexpr (std::endian::native != std::endian::little) value = reverse_bytes(value);
  std::memcpy(to, &value, sizeof(T));
}

/// Appends a T in little-endian order.
template <class T>
inline void append_little(std::vector<std::byte>& bytes, T value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(T));
  store_little(bytes.data() + at, value);
}

/// Appends the characters of `text`.
inline void append_text(std::vector<std::byte>& bytes, std::string_view text) {
  const std::size_t at = bytes.size();
  bytes.resize(at + text.size());
  if (!text.empty()) std::memcpy(bytes.data() + at, text.data(), text.size());
}

/// The bytes seen as characters, and the other way round.
[[nodiscard]] inline std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
[[nodiscard]] inline std::span<const std::byte> as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

}  // namespace varifold
