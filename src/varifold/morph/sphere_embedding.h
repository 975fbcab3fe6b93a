// A closed surface of genus 0 laid onto the sphere, without folds.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/base/result.h>
#include <varifold/morph/sphere_point.h>
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

/// The triangles whose corners are not strictly counter-clockwise on the sphere; exact.
[[nodiscard]] std::uint32_t count_flipped_on_sphere(std::span<const std::uint32_t> indices,
                                                    std::span<const SpherePoint> points);

}  // namespace varifold
