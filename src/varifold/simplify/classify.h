// Which edges are features, and of what kind each point therefore is.
#pragma once

#include <cstdint>
#include <varifold/simplify/working_surface.h>

namespace varifold {

/// How the faces around a point use one of its edges.
struct EdgeUse {
  std::uint32_t leaving = 0;   ///< faces (point, neighbour, ...)
  std::uint32_t arriving = 0;  ///< faces (point, ..., neighbour)
  bool seam = false;           ///< two faces that differ in material or chart
  [[nodiscard]] std::uint32_t faces() const { return leaving + arriving; }
  [[nodiscard]] bool is_feature() const { return leaving != 1 || arriving != 1 || seam; }
};

/// O(ring).
[[nodiscard]] EdgeUse edge_use(WorkingSurface& surface, std::uint32_t point,
                               std::uint32_t neighbor);

/// Sets PointState::kind and the flag kIrregular of every point. O(n), O(ring^2) where irregular.
void classify_points(WorkingSurface& surface, int threads);

}  // namespace varifold
