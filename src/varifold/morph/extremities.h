// The ends of a shape: feet, hands, noses, tails.
#pragma once

#include <varifold/morph/pair_growth.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// Vertices far from each other along the surface, and how far, as parts of the greatest distance.
struct Extremities {
  std::vector<std::uint32_t> vertices;
  std::vector<double> distances;  ///< rows and columns in the order of the vertices

  [[nodiscard]] double distance(std::size_t i, std::size_t j) const {
    return distances[i * vertices.size() + j];
  }
};

/// The first two are about as far apart as any, each further one is the farthest from all before;
/// `count` of them at most. Distances are those along edges. The ends of limbs come first.
/// O(count n log n).
[[nodiscard]] Extremities find_extremities(const SurfaceView& surface, std::size_t count);

}  // namespace varifold
