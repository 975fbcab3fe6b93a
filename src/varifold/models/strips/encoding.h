// The byte form of a strips framework; described in docs/formats/strips.md.
#pragma once

#include <varifold/base/result.h>
#include <varifold/models/strips/strip_framework.h>
#include <cstddef>
#include <span>
#include <vector>

namespace varifold {

/// decode_strip_framework() gives the same model, byte for byte. O(n).
[[nodiscard]] std::vector<std::byte> encode_strip_framework(const StripFramework& model);

/// Errors: kInvalidInput with the offset of the fault. Accepts any bytes: no more is allocated than
/// they justify, and a model that is returned has all indices in range, dependencies on finer steps
/// only, and at every level as many triangles as it says. O(bytes log bytes).
[[nodiscard]] Result<StripFramework> decode_strip_framework(std::span<const std::byte> bytes);

}  // namespace varifold
