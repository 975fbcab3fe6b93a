// Which triangle a strip may go to across an edge.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Half-edge 3 t + e is edge e of triangle t, from its corner e to its corner (e + 1) % 3.
///
/// Per half-edge, the half-edge that runs along it the other way, or kNone. There is one where
/// exactly two triangles have an edge on the same two vertices, in opposite directions, and both
/// are in the same material range: a strip stops at borders, at seams (the vertices differ), at
/// non-manifold edges, where orientations clash, and where the material changes. Triangles with
/// two equal corners have no neighbours and count at no edge. O(n log valence), 24 B a half-edge
/// while it runs.
[[nodiscard]] std::vector<std::uint32_t> edge_adjacency(const TriangleMesh& mesh);

/// Per triangle, the index of its material range; all zero where the mesh has no ranges.
[[nodiscard]] std::vector<std::uint32_t> triangle_ranges(const TriangleMesh& mesh);

[[nodiscard]] inline std::uint32_t next_half_edge(std::uint32_t half_edge) {
  return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
}
[[nodiscard]] inline std::uint32_t previous_half_edge(std::uint32_t half_edge) {
  return half_edge % 3 == 0 ? half_edge + 2 : half_edge - 1;
}

/// Whether two of the corners of a triangle are the same vertex.
[[nodiscard]] inline bool is_degenerate(std::span<const std::uint32_t> indices,
                                        std::uint32_t triangle) {
  const std::uint32_t* corner = indices.data() + 3 * std::size_t{triangle};
  return corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0];
}

}  // namespace varifold
