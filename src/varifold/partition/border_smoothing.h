// Makes the borders between patches shorter without moving their corners.
//
// Based on: [Birkholz2007] section 3 (figure 1).
// Differs: a path may leave the neighbourhood of the one before, but keeps off other borders, so
// that patches stay discs and never vanish; stretches
//   without a patch in common are worked on in parallel.
#pragma once

#include <varifold/partition/edge_links.h>
#include <varifold/partition/surface_view.h>
#include <cstdint>
#include <span>

namespace varifold {

struct SmoothedPatches {
  std::span<std::uint32_t> patch_of;  ///< per triangle; changed
  std::uint32_t count = 0;
  std::uint32_t max_triangles = ~0u;  ///< no patch grows beyond
};

struct SmoothingReport {
  std::uint32_t rounds = 0;
  std::int64_t edges = 0;  ///< by how many the borders have fewer
  double length = 0;       ///< by how much they are shorter, model units
};

/// Replaces every stretch of border between two corners by a shortest path over edges inside its
/// two patches, and again until nothing gets shorter by more than 1e-5 of a stretch; the triangles
/// between the old and the new path change sides. Fixed are corners, borders of materials, open and
/// non-manifold edges, borders without corners, and what a shorter path would lead around a handle
/// or a hole. The same result for any number of threads. About O(n), mostly for finding the
/// borders.
SmoothingReport smooth_borders(const SurfaceView& surface, const EdgeLinks& links,
                               const SmoothedPatches& patches, int threads);

}  // namespace varifold
