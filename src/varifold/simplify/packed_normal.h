// A direction in 32 bits: ten bits an axis.
#pragma once

#include <varifold/base/math.h>
#include <cstdint>

namespace varifold {

/// Zero stays zero. The direction is off by at most a tenth of a degree.
[[nodiscard]] inline std::uint32_t pack_normal(const Vec3& direction) {
  const Vec3 n = 511.0f * normalize_or_zero(direction);
  const auto axis = [](float x) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(x + 512.5f));  // above 0: rounds
  };
  return axis(n.x) | axis(n.y) << 10 | axis(n.z) << 20;
}

/// About 511 times the unit vector.
[[nodiscard]] inline Vec3 unpack_normal(std::uint32_t packed) {
  const auto axis = [](std::uint32_t bits) {
    return static_cast<float>(static_cast<std::int32_t>(bits & 1023) - 512);
  };
  return {axis(packed), axis(packed >> 10), axis(packed >> 20)};
}

}  // namespace varifold
