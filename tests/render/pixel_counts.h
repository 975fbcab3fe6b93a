// Counts of pixels that show faults of a surface.
#pragma once

#include <varifold/render/image.h>

namespace varifold::test {

[[nodiscard]] bool is_background(const DepthImage& depths, int x, int y);

/// Background pixels that cannot be reached from the picture's edge across the background.
[[nodiscard]] int enclosed_background_pixels(const DepthImage& depths);

/// Pixels that are clearly more red and blue than green: a magenta background shines through.
[[nodiscard]] int magenta_pixels_inside(const Image8& image, const DepthImage& depths);

/// Pixels much more red than green and blue, as tinted back faces are.
[[nodiscard]] int red_pixels(const Image8& image);

}  // namespace varifold::test
