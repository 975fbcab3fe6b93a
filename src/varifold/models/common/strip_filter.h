// Leaving out degenerate triangles of a strip while every other one keeps its orientation.
//
// Based on: [Ramos2008] section 3.4.1 and figure 3.11.
// Differs: the patterns a(aa)+ and ab(ab)+ of the text may lose an odd number of indices, which
// turns
//   the rest of the strip over; here indices go in pairs only, and at the ends.
#pragma once

#include <cstdint>
#include <span>

namespace varifold {

/// Writes the strip to `out`, which has room for all of it and does not overlap it, and returns how
/// many indices are left; 0 where all triangles are degenerate. abab becomes ab, aaaa aa, aabaa
/// aaa, wherever they stand; degenerate triangles at the end go, and at the beginning in pairs, or
/// one where only one or two triangles follow.
/// O(indices).
inline std::uint32_t filter_strip(std::span<const std::uint32_t> strip, std::uint32_t* out) {
  const auto degenerate = [&](std::uint32_t i) {
    return out[i] == out[i + 1] || out[i + 1] == out[i + 2] || out[i] == out[i + 2];
  };
  std::uint32_t n = 0;
  for (const std::uint32_t index : strip) {
    out[n++] = index;
    while (n >= 4) {
      const std::uint32_t* last = out + n - 1;
      if (last[0] == last[-2] && last[-1] == last[-3]) {
        n -= 2;  // abab, aaaa
      } else if (n >= 5 && last[0] == last[-1] && last[0] == last[-3] && last[0] == last[-4]) {
        out[n - 3] = last[0];  // aabaa
        n -= 2;
      } else if (n == 4 && degenerate(0) && degenerate(1)) {
        out[0] = out[2];
        out[1] = out[3];
        n = 2;
      } else {
        break;
      }
    }
  }
  while (n >= 3 && degenerate(n - 3)) --n;
  // One or two triangles behind a degenerate one that turns them: turned by their corners instead.
  if (n == 4 && degenerate(0)) {
    out[0] = out[2];
    out[2] = out[3];
    return 3;
  }
  if (n == 5 && degenerate(0) && !degenerate(1)) {
    out[0] = out[1];
    out[1] = out[3];
    out[3] = out[4];
    return 4;
  }
  return n >= 3 ? n : 0;
}

}  // namespace varifold
