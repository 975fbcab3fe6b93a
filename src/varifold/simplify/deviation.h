// The measured error of every level of a sequence.
//
// Based on: [Hoppe1996] section 4.1 (sample points stay attached to their nearest faces).
// Differs: the distance is the result, not a part of the cost; all vertices of the full mesh are
//   the samples.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/simplify/collapse_sequence.h>
#include <vector>

namespace varifold {

struct DeviationOptions {
  int threads = 0;
  Progress progress;
};

/// Sets `sequence.error` to measured distances: at every level, no vertex of the full mesh is
/// farther from the level's surface than the level's error.
///
/// Each vertex of the full mesh is carried along as a sample attached to a triangle near it. A
/// collapse moves the samples of the triangles that it touches to the nearest of the triangles that
/// it leaves there; the distance to that triangle is at least the distance to the whole surface, so
/// the bound holds, and seldom more, so it is tight. The error of a level is the maximum over all
/// samples at this and all finer levels. It does not bound how far the interiors of the level's
/// triangles stray from the full mesh (measure/ samples both directions).
///
/// Where the mesh takes several shapes (DetailedMesh::shapes()), this holds in each of them and in
/// every blend with weights >= 0 that sum up to 1: see NearestInShapes.
///
/// O(n log n) expected: about 25 distances to triangles a sample, in each shape. Returns false when
/// cancelled.
bool measure_deviation(DetailedMesh& detailed, const DeviationOptions& options);

/// What that is made of: per step, how far the samples that its collapse moves are from the
/// triangles that it leaves there; 0 where it moves none. Local, so that levels which differ from
/// place to place have a bound too. Empty when cancelled. O(n log n) expected.
[[nodiscard]] std::vector<float> step_deviations(const DetailedMesh& detailed,
                                                 const DeviationOptions& options);

}  // namespace varifold
