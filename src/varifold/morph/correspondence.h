// Which place of one closed surface becomes which of another one.
#pragma once

#include <varifold/base/result.h>
#include <varifold/morph/pair_growth.h>
#include <array>
#include <functional>
#include <span>
#include <vector>

namespace varifold {

struct CorrespondenceOptions {
  /// Vertices that shall meet.
  std::span<const FeaturePoint> features;
  int threads = 0;  ///< 0 = all; the result does not depend on it
  /// Called by the caller's thread; returning false cancels.
  std::function<bool(float done)> progress;
};

struct Correspondence {
  /// Positive maps of both onto the sphere: places in one direction meet.
  std::array<std::vector<SpherePoint>, 2> points;
  double distortion = 0;        ///< see PairGrowth::distortion(), of coarse surfaces
  double feature_distance = 0;  ///< of the farthest pair of features, in radians
};

/// Lays two closed surfaces of genus 0 onto one sphere so that they distort each other little, and
/// places that are alike meet.
///
/// Both are made coarse, and laid over each other in several ways: as the rotation of maps made for
/// each alone says that brings shapes together best; and with four ends of limbs of the one on four
/// of the other, for those pairs whose distances along the surfaces, and places, are most alike.
/// With four features or more, with four of these on each other. The way with the least distortion,
/// and distance between places that meet where shapes stand alike, is taken, and refined.
///
/// The surfaces must be closed, oriented, connected manifolds of genus 0 over vertices that are all
/// used; positions finite. Errors: kFailed where the resolution of the sphere (1e-12) does not
/// suffice; kCancelled. O(n log n).
[[nodiscard]] Result<Correspondence> find_correspondence(const std::array<SurfaceView, 2>& surfaces,
                                                         const CorrespondenceOptions& options = {});

}  // namespace varifold
