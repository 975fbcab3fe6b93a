// Walking around a point from triangle to triangle.
#pragma once

#include <varifold/partition/edge_links.h>
#include <varifold/partition/surface_view.h>

namespace varifold {

/// The other end of an edge at `point`.
[[nodiscard]] inline std::uint32_t other_end(const SurfaceView& surface, std::uint32_t half_edge,
                                             std::uint32_t point) {
  const std::uint32_t start = surface.corners[half_edge];
  return start == point ? surface.corners[next_in_triangle(half_edge)] : start;
}

/// Of a half-edge with an end at `point`: the other such half-edge of its triangle.
[[nodiscard]] inline std::uint32_t other_spoke(const SurfaceView& surface, std::uint32_t half_edge,
                                               std::uint32_t point) {
  const std::uint32_t next = next_in_triangle(half_edge);
  const bool has_point =
      surface.corners[next] == point || surface.corners[next_in_triangle(next)] == point;
  return has_point ? next : next_in_triangle(next);
}

}  // namespace varifold
