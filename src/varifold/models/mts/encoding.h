// The byte form of multiresolution triangle strips, described in docs/formats/mts.md.
#pragma once

#include <varifold/base/result.h>
#include <varifold/models/mts/multiresolution_strips.h>
#include <cstddef>
#include <span>
#include <vector>

namespace varifold {

/// All arrays as they are, by columns, so that they compress well. O(n).
[[nodiscard]] std::vector<std::byte> encode_mts(const MultiresolutionStrips& model);

/// Gives the encoded model, byte for byte. Accepts any bytes: every count, arc and vertex is
/// checked, so every walk ends, and every index of every level is a vertex of that level; which
/// triangles they make is not looked at (`varifold check` does). Allocates no more than a small
/// multiple of the bytes. Errors: kInvalidInput with the offset of the fault. O(bytes).
[[nodiscard]] Result<MultiresolutionStrips> decode_mts(std::span<const std::byte> bytes);

}  // namespace varifold
