// Two closed surfaces laid onto the sphere each for itself, and then turned and bent towards each
// other: what is left where they cannot be laid onto it together.
#pragma once

#include <varifold/morph/correspondence.h>

namespace varifold {

/// Maps of both, each with little distortion in itself; that of the second one is rotated until
/// the shapes, or features, meet as well as they may, and bent with features to those of the first.
/// Features that would have to pass each other may not get there. Distortion is left at 0.
///
/// Errors and demands as for find_correspondence(). O(n log n).
/// Based on: [Alexa2000].
[[nodiscard]] Result<Correspondence> map_separately(const std::array<SurfaceView, 2>& surfaces,
                                                    const CorrespondenceOptions& options = {});

}  // namespace varifold
