// PNG pictures to and from bytes; files are the caller's affair.
#pragma once

#include <varifold/base/result.h>
#include <varifold/render/image.h>
#include <cstddef>
#include <span>
#include <vector>

namespace varifold {

/// The widest and highest picture that is read.
inline constexpr int kMaxPictureSize = 1 << 14;

/// Encodes a picture, 8 bits per channel, RGB. kFailed for an empty picture or when memory ends.
[[nodiscard]] Result<std::vector<std::byte>> write_png(const Image8& image);

/// Decodes any PNG to 8-bit RGB; alpha is dropped, grey becomes equal channels, the upper 8 of 16
/// bits remain. kInvalidInput for what is no PNG or is damaged, kUnsupported for a side above
/// kMaxPictureSize. Check sums inside the file are not verified.
[[nodiscard]] Result<Image8> read_png(std::span<const std::byte> bytes);

/// Decodes a PNG of 8 or 16 bits per channel to heights; of a colour picture, its luminance, of
/// an alpha channel, nothing. Errors as read_png.
[[nodiscard]] Result<HeightMap> read_height_map(std::span<const std::byte> bytes);

}  // namespace varifold
