// Animated weights of poses as glTF wants them: one channel for all poses of a mesh.
#pragma once

#include <varifold/mesh/rig.h>
#include <cstddef>
#include <optional>
#include <vector>

namespace varifold::gltf {

/// One channel that weighs all `pose_count` poses as the channels of the animation do; poses that
/// none of them moves have their weight at rest (0 where `rest` is empty). Nothing where there are
/// no such channels.
/// Exact where one channel weighs all poses, where all are linear and where all are steps; else
/// linear between 60 samples a second and the keys.
[[nodiscard]] std::optional<AnimationChannel> merge_pose_channels(const Animation& animation,
                                                                  std::size_t pose_count,
                                                                  const std::vector<float>& rest);

}  // namespace varifold::gltf
