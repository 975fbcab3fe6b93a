// How far two pictures are apart.
#pragma once

#include <varifold/base/result.h>
#include <varifold/render/image.h>

namespace varifold {

struct ImageDifference {
  int max = 0;            ///< largest difference of a channel, 0 to 255
  double rms = 0;         ///< root mean square over all channels, 0 to 255
  double part_above = 0;  ///< part of the pixels with a channel that differs by more than asked
};

/// Compares two pictures of one size (kInvalidInput otherwise), channel by channel in sRGB values.
/// A pixel counts for `part_above` when a channel differs by more than `threshold`. O(pixels).
[[nodiscard]] Result<ImageDifference> image_difference(const Image8& a, const Image8& b,
                                                       int threshold = 0);

}  // namespace varifold
