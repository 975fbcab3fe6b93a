// Other libraries doing the same job, for comparison in the same run.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>

namespace varifold::bench {

/// meshoptimizer's simplifier without a limit of the error: the vertices of `mesh` with at most
/// `triangles` triangles, if it gets there.
[[nodiscard]] TriangleMesh meshoptimizer_simplify(const TriangleMesh& mesh,
                                                  std::uint32_t triangles);

}  // namespace varifold::bench
