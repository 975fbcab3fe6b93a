// The borders between patches, cut at the points where more than two patches meet.
#pragma once

#include <varifold/base/large_vector.h>
#include <varifold/partition/edge_links.h>
#include <varifold/partition/surface_view.h>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// A stretch of border between two patches of one material, from corner to corner.
struct Stretch {
  std::uint32_t a = 0, b = 0;                 ///< the patches
  std::vector<std::uint32_t> path;            ///< points, corners included
  std::array<std::uint32_t, 2> end_spokes{};  ///< half-edges on the first and the last edge
};

/// What the borders leave to a point.
struct PointUse {
  static constexpr std::uint32_t kInside = kNone;     ///< of one patch
  static constexpr std::uint32_t kFixed = kNone - 1;  ///< a corner, or something else immovable
};

struct BorderStretches {
  /// Without those that have one edge, that end where they begin, or that have no corner.
  std::vector<Stretch> stretches;
  /// Per point: kInside, kFixed, or the stretch that it is an inner point of.
  LargeVector<std::uint32_t> use_of;
  LargeVector<std::uint32_t> spokes;        ///< per point: a half-edge that starts there
  LargeVector<std::uint32_t> triangles_at;  ///< per point: how many
};

/// Whether walking around the point that `spoke` starts at closes after so many triangles.
[[nodiscard]] bool is_closed_fan(const SurfaceView& surface, const EdgeLinks& links,
                                 std::uint32_t spoke, std::uint32_t triangles);

/// A corner is a point where three patches meet, or two and something that cannot move: an open or
/// non-manifold edge or one between materials, or a point where fans of triangles touch. O(n).
[[nodiscard]] BorderStretches find_stretches(const SurfaceView& surface, const EdgeLinks& links,
                                             std::span<const std::uint32_t> patch_of);

}  // namespace varifold
