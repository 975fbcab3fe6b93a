// Errors in two bytes: the upper half of a float, rounded up, so that a bound stays a bound.
#pragma once

#include <bit>
#include <cstdint>

namespace varifold {

/// The float that a code stands for; at least 0. Codes below kErrorCodes order as their values do.
[[nodiscard]] inline float error_of_code(std::uint32_t code) {
  return std::bit_cast<float>(code << 16);
}

/// All codes lie below this; the last one is infinity.
inline constexpr std::uint32_t kErrorCodes = 0x7f81;

/// The code of the least value that is not below `error`, at most 1/128 above it where it is at
/// least 1e-36. 0 for what is not above 0; infinity for what is not a number.
[[nodiscard]] inline std::uint32_t error_code(float error) {
  if (error <= 0) return 0;
  const auto bits = std::bit_cast<std::uint32_t>(error);
  const std::uint32_t code = (bits >> 16) + ((bits & 0xffffu) != 0 ? 1 : 0);
  return code < kErrorCodes ? code : kErrorCodes - 1;
}

}  // namespace varifold
