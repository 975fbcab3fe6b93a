// How different two pictures look to someone who flips between them.
//
// Based on: [Andersson2020] sections 4 and 5, for pictures of low dynamic range.
#pragma once

#include <varifold/base/result.h>
#include <varifold/render/image.h>
#include <vector>

namespace varifold {

struct FlipOptions {
  /// How many pixels the eye sees side by side in a degree. As published: a picture 3840 pixels
  /// and 0.7 m wide, seen from 0.7 m.
  float pixels_per_degree = 67.02f;
};

/// The difference of each pixel, 0 (none) to 1, row by row. The order of the pictures does not
/// matter. kInvalidInput where their sizes differ. O(pixels * pixels_per_degree).
[[nodiscard]] Result<std::vector<float>> flip_differences(const Image8& a, const Image8& b,
                                                          const FlipOptions& options = {});

/// The mean of all pixels; 0 for empty pictures.
[[nodiscard]] Result<double> flip_difference(const Image8& a, const Image8& b,
                                             const FlipOptions& options = {});

}  // namespace varifold
