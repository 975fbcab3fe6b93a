// Which frames can share a sequence.
#pragma once

#include <varifold/mesh/pose.h>
#include <varifold/simplify/collapse_sequence.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// How far the vertices of full detail are from a level, in root mean square, if the mesh has that
/// shape: each to the nearest of the triangles around the vertex that stands for it. `shape` has
/// the places in the numbers of `detailed`. O(vertices).
[[nodiscard]] double level_distance(const DetailedMesh& detailed, std::uint32_t level,
                                    std::span<const Vec3> shape);

/// Groups frames around some of them: `loss[i * count + j]` is what the sequence of frame i costs
/// in frame j. Returns for each frame its group, numbered by their first frames. The centres are
/// chosen one after the other, each so that the greatest ratio of a frame's loss to that of its own
/// sequence becomes least, then exchanged as long as that helps. Deterministic.
/// O(frames^2 * groups) for each exchange.
[[nodiscard]] std::vector<std::uint32_t> group_frames(std::span<const double> loss,
                                                      std::uint32_t count, std::uint32_t groups);

}  // namespace varifold
