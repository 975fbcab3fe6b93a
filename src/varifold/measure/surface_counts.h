// Private to this folder: what of a surface must not change from level to level and front to front.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <string>
#include <vector>

namespace varifold::check {

/// Judged on positions; triangles with two corners at one position count nowhere else.
struct SurfaceCounts {
  std::uint64_t boundary_edges = 0;     ///< with one triangle
  std::uint64_t nonmanifold_edges = 0;  ///< with three or more
  std::uint64_t misoriented_edges = 0;  ///< with two that run along it in the same direction
  std::uint64_t duplicate_triangles = 0;
  std::uint64_t degenerate_triangles = 0;
  /// The Euler characteristic of each component (joined by common positions), ascending.
  std::vector<std::int64_t> euler_of_component;
};

/// Indices must be valid. O(n log n), on the calling thread.
[[nodiscard]] SurfaceCounts count_surface(const TriangleMesh& mesh);

/// Whether `parts` are all among `whole`, each as often at most; both ascending.
[[nodiscard]] bool are_among(const std::vector<std::int64_t>& parts,
                             const std::vector<std::int64_t>& whole);

}  // namespace varifold::check
