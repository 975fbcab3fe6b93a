// Components that vanish: what cannot be simplified any more and lies inside one patch may go.
#pragma once

#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <utility>
#include <vector>

namespace varifold {

/// Takes components out of the surface, those of the least extent first, until it has at most
/// `target_faces` faces or none is left that may go: one that lies wholly in a region that has
/// others, too. The one of greatest extent stays in each region. Gives the points that are gone,
/// each with the point that its component shrinks to: the nearest one that is left in the region.
/// O(points) for each component that goes.
[[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>> remove_components(
    WorkingSurface& surface, std::uint32_t target_faces);

}  // namespace varifold
