// Which edges are features, and of what kind each point therefore is.
#pragma once

#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <span>

namespace varifold {

/// How the faces around a point use one of its edges.
struct EdgeUse {
  std::uint32_t leaving = 0;   ///< faces (point, neighbour, ...)
  std::uint32_t arriving = 0;  ///< faces (point, ..., neighbour)
  bool seam = false;           ///< two faces that differ in material or chart
  bool region = false;         ///< two faces of different regions
  [[nodiscard]] std::uint32_t faces() const { return leaving + arriving; }
  [[nodiscard]] bool is_feature() const { return leaving != 1 || arriving != 1 || seam || region; }
};

/// O(ring).
[[nodiscard]] EdgeUse edge_use(WorkingSurface& surface, std::uint32_t point,
                               std::uint32_t neighbor);
/// Of the neighbour in that place of the ring. O(1) but for points with several fans.
[[nodiscard]] EdgeUse edge_use_at(WorkingSurface& surface, std::uint32_t point, std::size_t place);

/// Calls visit(wedge of point, wedge of onto) for every side of the edge between two neighbours,
/// once a side.
template <class Visit>
void for_edge_wedges(const WorkingSurface& surface, std::uint32_t point, std::uint32_t onto,
                     const Visit& visit) {
  const WedgeTables& wedge = surface.wedge;
  if (wedge.count_of(point) == 1 && wedge.count_of(onto) == 1)
    return visit(wedge.first_of(point), wedge.first_of(onto));
  const RingEntry* ring = surface.ring(point);
  const std::uint32_t size = surface.points[point].ring_size;
  std::uint32_t previous = kNone;
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::uint32_t next = ring[i + 1 == size ? 0 : i + 1].neighbor;
    if (ring[i].face == kNone || (ring[i].neighbor != onto && next != onto)) continue;
    const std::uint32_t w = wedge.at_corner(ring[i].face, point);
    if (w != previous) visit(w, wedge.at_corner(ring[i].face, onto));
    previous = w;
  }
}

/// Sets PointState::kind and the flag kIrregular of every point. O(n), O(ring^2) where irregular.
void classify_points(WorkingSurface& surface, int threads);

/// The same for some live points where regions have been merged since: points without features have
/// none now, either. O(points), O(ring) where there were some.
void reclassify_points(WorkingSurface& surface, std::span<const std::uint32_t> live, int threads);

}  // namespace varifold
