// The boundaries of discs on the equator of the sphere, and two of them made one.
// Internal to this folder.
#pragma once

#include <varifold/base/result.h>
#include <varifold/morph/disc_cuts.h>
#include <varifold/morph/overlay.h>
#include <varifold/morph/sphere_point.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// A disc laid onto the upper half of the sphere: its boundary on the equator (z is exactly 0,
/// so that any three points of it are exactly on one great circle), all else above.
struct DiscMap {
  DiscMesh disc;
  std::vector<SpherePoint> points;  ///< per point of the surface
};

/// The triangles of the disc, then a fan of its boundary about one more point, the south pole,
/// which closes the surface.
[[nodiscard]] std::vector<std::uint32_t> capped_indices(const SphereSurface& surface);
/// The points with that pole, for capped_indices().
[[nodiscard]] std::vector<SpherePoint> capped_points(std::span<const SpherePoint> points);
inline constexpr SpherePoint kSouthPole{0, 0, -std::int64_t{1} << 40};

/// A point of the boundary that shall come to a given place of the equator.
struct BoundaryAnchor {
  std::uint32_t point = 0;
  double at = 0;      ///< the part of a full turn, in [0, 1)
  SpherePoint place;  ///< the same
};

/// The point of the equator at a part of a full turn.
[[nodiscard]] SpherePoint equator_point(double turn);

/// Where the points of the boundary are, as parts of a full turn in the order of surface.boundary:
/// by the lengths of the edges, of which each counts as a hundredth of the mean at least; between
/// anchors, which must come in the order of the boundary, in proportion. O(boundary).
[[nodiscard]] std::vector<double> boundary_turns(const SphereSurface& surface,
                                                 std::span<const BoundaryAnchor> anchors);

/// Lays the boundary onto the equator: edges that would take more than a fifth of it are halved,
/// and chords are cut, so that every triangle fits into half the sphere. Other points get no place.
/// kFailed where the resolution of the sphere does not suffice. O(n log n).
[[nodiscard]] Result<void> lay_boundary(DiscMap& map, std::span<const BoundaryAnchor> anchors);

/// Cuts boundary edges of each where the other one has a point, so that both boundaries are one
/// loop, and says who is who; poles, too. Places of b that are equal directions become equal.
/// O(n log n).
[[nodiscard]] SharedPoints merge_boundaries(DiscMap& a, DiscMap& b);

}  // namespace varifold
