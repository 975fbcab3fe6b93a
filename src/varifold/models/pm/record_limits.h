// What one split can hold; see VertexSplit.
#pragma once

#include <cstdint>

namespace varifold::pm {

inline constexpr std::uint32_t kMaxWedges = 255;
inline constexpr std::uint32_t kMaxTriangles = 255;
inline constexpr std::uint32_t kMaxSlots = 65535 - kMaxWedges;  // room for kNoSlot

}  // namespace varifold::pm
