// Turns one map onto the half of the sphere about its axis so that it meets another one where the
// shapes are alike.
#pragma once

#include <varifold/morph/alignment.h>
#include <span>

namespace varifold {

/// The turn of the half-sphere of `b` about its axis, as a part of a full one, under which places
/// of the shapes that meet are closest, least squares over the half-sphere and its border; shapes
/// are compared with their middles together and at one size. They should stand alike; but if one of
/// them turned by a multiple of 90 degrees about axes fits clearly better, it is compared so.
/// Positions need none for the pole. O(n + 7 million differences), the same result always.
[[nodiscard]] double align_discs(const SphereMap& a, const SphereMap& b);

/// The turn of the half-sphere of `b` about its axis, as a part of a full one, that brings each
/// pair of features (points of a, of b) closest together, least squares. O(features).
[[nodiscard]] double align_disc_features(const SphereMap& a, const SphereMap& b,
                                         std::span<const FeaturePoint> features);

}  // namespace varifold
