// From a mesh with poses to its FrameStrips.
//
// Based on: [Ramos2008] section 6.3.2 and figure 6.4 (LOD builder).
#pragma once

#include <varifold/base/progress.h>
#include <varifold/base/result.h>
#include <varifold/models/lodstrips/frame_strips.h>
#include <varifold/simplify/simplify.h>
#include <varifold/strip/stripify.h>
#include <cstdint>
#include <vector>

namespace varifold {

struct FrameStripsOptions {
  /// The weights of the poses in each frame; empty: the mesh at rest and each pose by itself.
  std::vector<std::vector<float>> frames;
  /// How many sequences there are; 0, or as many as frames: each frame has its own.
  std::uint32_t sequences = 0;
  SimplifyOptions simplify;  ///< of each sequence; `poses` and `target_triangles` are not heeded
  /// Strips of full detail.
  StripifyOptions stripify{.max_indices = 0xffff};
};

struct FrameStripsBuild {
  FrameStrips model;
  InputFaults faults;
  StopReport stop;  ///< of the sequence that ends with the most triangles
  double simplify_seconds = 0, measure_seconds = 0, cluster_seconds = 0;
};

/// The shape of each frame. O(frames * vertices).
[[nodiscard]] std::vector<Pose> frame_shapes(const TriangleMesh& mesh,
                                             const std::vector<std::vector<float>>& frames);

/// Simplifies each frame by itself, or groups of frames, each by one sequence for all of its
/// shapes. Groups are found by what the sequences of single frames cost in the others
/// (frame_clusters.h). Errors are measured in the frames that a sequence serves, and hold in blends
/// of these. All sequences end with the same number of collapses.
///
/// Errors: those of simplify(). O(frames * n log n), and with groups O(frames^2 * n) more.
[[nodiscard]] Result<FrameStripsBuild> build_frame_strips(const TriangleMesh& mesh,
                                                          const FrameStripsOptions& options = {});

/// `count` frames from the shape at rest to the first pose, both included, as the thesis has them.
[[nodiscard]] std::vector<std::vector<float>> morph_frames(std::uint32_t count);

}  // namespace varifold
