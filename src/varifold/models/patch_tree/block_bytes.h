// Private to this folder: what writing and reading the blocks of patches agree on.
#pragma once

#include <cstddef>
#include <cstdint>

namespace varifold {

inline constexpr char kPatchTreeTag[] = "VPT1";

/// Numbers below `count` take so many bytes each.
[[nodiscard]] inline std::size_t bytes_of_number(std::uint32_t count) {
  return count <= 256 ? 1 : 2;
}

/// Vertices of a patch have numbers of 16 bits.
inline constexpr std::uint32_t kMaxPatchVertices = 65536;

}  // namespace varifold
