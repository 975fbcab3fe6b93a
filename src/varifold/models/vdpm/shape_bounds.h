// The bounds of steps of a mesh that takes several shapes: they hold in every blend of them.
#pragma once

#include <varifold/models/vdpm/step_bounds.h>

namespace varifold {

/// For every step the middle of where its first vertex is in all shapes. O(steps * shapes).
[[nodiscard]] std::vector<Vec3> shape_centers(const DetailedMesh& detailed);

/// Vertex, cone, radius, mu and delta of every step; the balls are about `centers`.
///
/// With weights >= 0 that sum up to 1 a blend puts every vertex into the convex hull of where its
/// shapes have it, so a ball that holds these holds it. The normal of a triangle in a blend, as
/// long as twice its area, is sum_ij w_i w_j N_ij, where N_ij is half the sum of e_i x f_j and e_j
/// x f_i for its edges e and f: a cone of less than 90 degrees that holds all N_ij holds it, and
/// one that does not is wide. Deviation spaces are convex, and hold what NearestInShapes says.
///
/// `options.vertical` and `inside_triangles` are not for these. Returns false when cancelled.
bool measure_bounds_in_shapes(const DetailedMesh& detailed, const StepBoundsOptions& options,
                              const SequenceHistory* history, std::span<const Vec3> centers,
                              std::vector<StepBounds>& bounds);

}  // namespace varifold
