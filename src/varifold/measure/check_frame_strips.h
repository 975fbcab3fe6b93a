// Proves LodStrips of frames sound, or lists what is not.
#pragma once

#include <varifold/measure/check_model.h>
#include <varifold/models/lodstrips/frame_strips.h>
#include <memory>

namespace varifold {

/// check_model() of every frame, with the mesh in the shape of that frame; kinds have frame_ before
/// their names and places name the frame. Errors: kCancelled. O(frames * n log n) a level.
[[nodiscard]] Result<ModelCheck> check_frame_strips(const std::shared_ptr<const FrameStrips>& model,
                                                    const ModelCheckOptions& options = {});

}  // namespace varifold
