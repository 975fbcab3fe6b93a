// Finding levels by what they have.
#pragma once

#include <cstdint>

namespace varifold {

/// The last level in [0, finest] for which `fits` holds, where it holds up to some level and not
/// beyond; 0 where it holds for none. O(log finest) calls.
template <class Fits>
[[nodiscard]] std::uint32_t last_level(std::uint32_t finest, const Fits& fits) {
  std::uint32_t low = 0, high = finest;
  while (low < high) {
    const std::uint32_t middle = low + (high - low + 1) / 2;
    if (fits(middle))
      low = middle;
    else
      high = middle - 1;
  }
  return low;
}

}  // namespace varifold
