// Cuts a surface into compact patches of about equal numbers of triangles.
//
// Based on: [Birkholz2007] section 3.
// Differs: patches are discs where the surface allows it, of one material, and triangles around
//   non-manifold edges stay together; small components share patches; see merge_rounds.h for the
//   order of the merges.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/partition/edge_links.h>
#include <varifold/partition/surface_view.h>
#include <cstdint>
#include <vector>

namespace varifold {

struct PartitionOptions {
  std::uint32_t triangles_per_patch = 1000;  ///< the mean that is aimed at; at least 1
  bool smooth = true;                        ///< shorten the borders between the patches
  int threads = 0;                           ///< 0 = all
  Progress progress;                         ///< stage "patches"
};

struct Partition {
  std::vector<std::uint32_t> patch_of;  ///< per triangle
  std::uint32_t patch_count = 0;
  bool cancelled = false;  ///< by the progress callback; the rest is then empty

  std::vector<std::int32_t> euler;       ///< Euler characteristics of the patches: of discs 1
  std::uint32_t non_discs = 0;           ///< patches whose Euler characteristic is not 1
  std::uint64_t border_edges = 0;        ///< edges between two patches
  double border_length = 0;              ///< of these edges, model units
  std::uint64_t rough_border_edges = 0;  ///< the same before smoothing
  double rough_border_length = 0;
  std::uint32_t smoothing_rounds = 0;
};

/// No patch has more than this many times the wanted number of triangles.
inline constexpr float kMaxPatchExcess = 2.5f;

/// Every triangle in one patch; no patch is empty. The patches of a region, that is, of triangles
/// of one material linked by edges, are connected by edges, of one material, and numbered along the
/// numbers of the triangles; there are about triangle_count / triangles_per_patch of them. Regions
/// of less than half a patch share patches with others of their material. The same result for any
/// number of threads. About O(n).
[[nodiscard]] Partition make_patches(const SurfaceView& surface,
                                     const PartitionOptions& options = {});
/// The same where the links of the surface are known.
[[nodiscard]] Partition make_patches(const SurfaceView& surface, const EdgeLinks& links,
                                     const PartitionOptions& options);

}  // namespace varifold
