// Two triangulations of the sphere, or of half of it, laid over each other.
#pragma once

#include <varifold/base/result.h>
#include <varifold/morph/sphere_triangulation.h>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace varifold {

/// Of two discs: their boundaries are one loop of the same places, and fans about one pole close
/// both below. Empty for closed surfaces.
struct SharedPoints {
  std::vector<std::uint32_t> in_b;  ///< per vertex of a, that of b if they are one; or kNone
  std::vector<std::uint32_t> in_a;  ///< per vertex of b

  [[nodiscard]] bool of_discs() const { return !in_b.empty(); }
};

/// A point where an edge of a crosses one of b.
struct Crossing {
  std::uint32_t edge_a = 0, edge_b = 0;
  std::uint32_t place_a = 0, place_b = 0;  ///< which one it is, along the first half-edge of each
  /// Seen along the first half-edge of b, whether that of a comes from the right.
  bool is_a_from_right = false;
};

/// All crossings, and the triangle of the other one that each vertex lies in.
struct Crossings {
  std::vector<Crossing> crossings;              ///< by edges of b, along each
  std::vector<std::uint32_t> first_on_a, on_a;  ///< per edge of a (rows), along it: crossings
  std::vector<std::uint32_t> first_on_b;        ///< per edge of b, its first crossing
  std::vector<std::uint32_t> triangle_in_b;     ///< per vertex of a
  std::vector<std::uint32_t> triangle_in_a;     ///< per vertex of b
  SharedPoints shared;
  bool is_complete = true;  ///< false: there are too many, and none of this is filled
};

/// Follows every edge of each over the other by the signs of determinants of given directions,
/// which are exact, so that both walks see the same crossings. Nothing where a vertex of one lies
/// exactly on an edge's great circle of the other, as far as that was asked: move one of them a
/// little and try again. Incomplete where there are more than 32 for each triangle and a million:
/// needles across needles, for which memory would not do. Both must cover the sphere once. Edges
/// between shared points cross nothing: they are those of the boundaries and fans, no others may
/// join two. O(n + crossings log), in parallel (0 threads = all); the same for any number.
[[nodiscard]] std::optional<Crossings> find_crossings(const SphereTriangulation& a,
                                                      const SphereTriangulation& b, int threads,
                                                      SharedPoints shared = {});

/// A convex piece of the sphere within one triangle of each. Nodes are vertices of a, then those
/// of b, then crossings; a shared vertex is that of a.
struct OverlayCells {
  std::vector<std::uint32_t> first_node;              ///< per cell, into `nodes`; size cells + 1
  std::vector<std::uint32_t> nodes;                   ///< counter-clockwise seen from outside
  std::vector<std::uint32_t> triangle_a, triangle_b;  ///< per cell

  [[nodiscard]] std::uint32_t cell_count() const {
    return static_cast<std::uint32_t>(triangle_a.size());
  }
  [[nodiscard]] std::span<const std::uint32_t> cell(std::uint32_t index) const {
    return {nodes.data() + first_node[index], nodes.data() + first_node[index + 1]};
  }
};

/// The cells that the edges of both cut the sphere into; of discs, those of the upper half. No
/// three nodes of a cell lie on one great circle. O(n + crossings).
[[nodiscard]] OverlayCells trace_cells(const SphereTriangulation& a, const SphereTriangulation& b,
                                       const Crossings& crossings);

}  // namespace varifold
