// Ends of limbs of one shape and those of another that may be the same. Internal to this folder.
#pragma once

#include <varifold/morph/alignment.h>
#include <varifold/morph/extremities.h>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace varifold {

/// Four vertices of each of two surfaces.
using LimbPairs = std::array<FeaturePoint, 4>;

/// The likeliest pairs of four extremities, `count` at most: those whose distances from each other
/// along the surfaces, and places once the second shape is turned, are most alike.
[[nodiscard]] std::vector<LimbPairs> pair_limbs(const std::array<SurfaceView, 2>& surfaces,
                                                const std::array<Extremities, 2>& limbs,
                                                const Rotation& turn_of_b, std::size_t count);

/// Fours of the features, `count` at most, beginning with those that are farthest from each other.
[[nodiscard]] std::vector<LimbPairs> widest_fours(const std::array<SurfaceView, 2>& surfaces,
                                                  std::span<const FeaturePoint> features,
                                                  std::size_t count);

}  // namespace varifold
