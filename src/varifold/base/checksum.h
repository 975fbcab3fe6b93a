// Checksums of byte spans: XXH3, 64 bits (xxhash.com), as stored in .vfm files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace varifold {

[[nodiscard]] std::uint64_t checksum(std::span<const std::byte> bytes);

}  // namespace varifold
