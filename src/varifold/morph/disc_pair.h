// Two discs on the upper half of the sphere, from their boundaries to one triangulation each that
// is ready to be laid over the other. Internal to this folder.
#pragma once

#include <varifold/base/result.h>
#include <varifold/morph/disc_alignment.h>
#include <varifold/morph/disc_boundary.h>
#include <array>
#include <string>
#include <vector>

namespace varifold {

struct DiscPair {
  std::array<DiscMap, 2> maps;
  std::vector<FeaturePoint> inside, on_boundary;  ///< features: points of the first, the second
};

/// Lays both boundaries onto the equator, where features on them meet exactly. kInvalidInput where
/// a feature is on one of the boundaries only, or those of one boundary come in another order on
/// the other one. O(n log n).
[[nodiscard]] Result<void> lay_boundaries(DiscPair& pair,
                                          const std::vector<FeaturePoint>& features);

/// Turns the second map, which must be an embedding as the first one is, about the axis until
/// features meet, or without any until the shapes are alike; then drags features inside together.
/// How far the farthest pair of features is apart in the end, in radians.
[[nodiscard]] Result<double> bring_together(DiscPair& pair);

/// A disc closed by a fan about the south pole below, which stands for its border.
struct CappedDisc {
  TriangleMesh mesh;
  SphereSurface surface;  ///< `indices` and `positions` with the fan, `triangles` without
  std::vector<SpherePoint> points;
  std::vector<bool> is_fixed;  ///< points of the boundary, and the pole
};
[[nodiscard]] CappedDisc capped(DiscMap map);

}  // namespace varifold
