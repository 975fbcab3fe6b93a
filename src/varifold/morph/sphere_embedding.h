// A closed surface of genus 0 laid onto the sphere, or a disc onto half of it, without folds.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/base/result.h>
#include <varifold/morph/sphere_point.h>
#include <varifold/morph/sphere_surface.h>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace varifold {

struct SphereEmbeddingOptions {
  int final_sweeps = 20;  ///< passes over all vertices at the end
  /// Asked now and then with the part that is done; returning false cancels.
  std::function<bool(float done)> progress;
};

/// A direction for every vertex such that all triangles are positive (orientation() of their
/// corners is 1) and cover the sphere once, with little distortion of angles and areas.
///
/// `indices` must be a closed, oriented, connected manifold of genus 0 over vertices that are all
/// used; `positions` finite. Errors: kFailed where the resolution of the sphere (1e-12) does not
/// suffice; kCancelled. O(n log n), one thread.
/// Based on: [PraunHoppe2003] section 3.
[[nodiscard]] Result<std::vector<SpherePoint>> embed_on_sphere(
    std::span<const std::uint32_t> indices, std::span<const Vec3> positions,
    const SphereEmbeddingOptions& options = {});

/// The same for a disc and the upper half of the sphere. `points` has a place for every point
/// of disc.boundary, in their order on the equator (z = 0) and less than half a turn apart. No edge
/// inside may join two of these, and no triangle may have three (disc_cuts.h).
[[nodiscard]] Result<std::vector<SpherePoint>> embed_on_half_sphere(
    const SphereSurface& disc, std::vector<SpherePoint> points,
    const SphereEmbeddingOptions& options = {});

/// The triangles whose corners are not strictly counter-clockwise on the sphere; exact.
[[nodiscard]] std::uint32_t count_flipped_on_sphere(std::span<const std::uint32_t> indices,
                                                    std::span<const SpherePoint> points);

}  // namespace varifold
