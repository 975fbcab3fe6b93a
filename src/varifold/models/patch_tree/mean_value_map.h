// Where the vertices of fine patches lie in the coarse one, by mean value coordinates.
//
// Based on: [Birkholz2007] section 3 (priorities); [Floater2003].
// Differs: where the coordinates say nothing (angles near 180 degrees, no vertex in reach that
//   stays), the caller is told. The images are weighted means of places in space, so they lie on a
//   membrane between the vertices that stay rather than on the coarse triangles.
#pragma once

#include <varifold/base/math.h>
#include <cstdint>
#include <span>

namespace varifold {

/// A piece of surface and which of its vertices stay where they are.
struct MappedPiece {
  std::span<const std::uint32_t> corners;  ///< three per triangle
  std::span<const Vec3> positions;
  std::span<const std::uint8_t> is_locked;  ///< per vertex
};

/// Moves every vertex that is not locked to the mean of its neighbours, weighted by mean value
/// coordinates, on rims of the piece by its two neighbours there: all at once, by relaxation.
/// `squared` gets the squared distance of each vertex from its image; negative where there is none.
/// O(vertices x rounds), some dozens of rounds.
void map_by_mean_values(const MappedPiece& piece, std::span<float> squared);

}  // namespace varifold
