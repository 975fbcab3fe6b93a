// Sorting points along a Morton curve, so that neighbours in space are neighbours in memory.
//
// Based on: [Morton1966].
#pragma once

#include <varifold/base/math.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// The ids of `chosen` sorted by the Morton code (10 bits an axis) of their positions in `box`;
/// ties keep their order. O(n).
[[nodiscard]] std::vector<std::uint32_t> morton_order(std::span<const Vec3> positions,
                                                      std::span<const std::uint32_t> chosen,
                                                      const Box& box);

}  // namespace varifold
