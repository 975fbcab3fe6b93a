// A short way around a handle.
#pragma once

#include <varifold/morph/sphere_triangulation.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// The half-edges of a closed way along edges that does not part the surface, each vertex at most
/// once; empty where there is none: on a sphere. `surface` must be closed, manifold and of
/// one component; its points are not looked at, and need not all be used. Short, but not the
/// shortest: ways through one vertex are compared, then those through the vertices of the best,
/// until none is shorter. O(n) for each vertex tried.
/// Based on: [Eppstein2003], the tree and cotree of a surface.
[[nodiscard]] std::vector<std::uint32_t> find_handle_loop(const SphereTriangulation& surface);

}  // namespace varifold
