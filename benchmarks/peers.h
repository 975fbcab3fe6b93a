// Other libraries doing the same job, for comparison in the same run.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <vector>

namespace varifold::bench {

/// meshoptimizer's simplifier without a limit of the error: the vertices of `mesh` with at most
/// `triangles` triangles, if it gets there.
[[nodiscard]] TriangleMesh meshoptimizer_simplify(const TriangleMesh& mesh,
                                                  std::uint32_t triangles);

/// meshoptimizer's order of triangles for a vertex cache, as a list.
[[nodiscard]] std::vector<std::uint32_t> meshoptimizer_cache_order(const TriangleMesh& mesh);

/// meshoptimizer's strips of its order for strips, divided by kStripRestart.
[[nodiscard]] std::vector<std::uint32_t> meshoptimizer_strips(const TriangleMesh& mesh);

}  // namespace varifold::bench
