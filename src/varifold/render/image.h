// Pictures in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

/// An sRGB picture; row 0 is the top one.
struct Image8 {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 * width * height

  /// The three bytes of a pixel.
  [[nodiscard]] const std::uint8_t* pixel(int x, int y) const {
    return rgb.data() + 3 * (static_cast<std::size_t>(y) * width + x);
  }
  friend bool operator==(const Image8&, const Image8&) = default;
};

/// Distances along the line of sight, in model units; infinity where nothing was drawn. Row 0 is
/// the top one.
struct DepthImage {
  int width = 0;
  int height = 0;
  std::vector<float> depths;  ///< width * height

  [[nodiscard]] float depth(int x, int y) const {
    return depths[static_cast<std::size_t>(y) * width + x];
  }
};

/// Heights of a terrain, as a picture gives them; row 0 is the top one.
struct HeightMap {
  int width = 0;
  int height = 0;
  std::vector<float> heights;  ///< width * height, 0 (black) to 1 (white)
};

}  // namespace varifold
