// The bounds of steps of a mesh that takes several shapes: they hold in every blend of them.
#pragma once

#include <varifold/models/vdpm/step_bounds.h>

namespace varifold {

/// For every step the middle of where its first vertex is in all shapes. O(steps * shapes).
[[nodiscard]] std::vector<Vec3> shape_centers(const DetailedMesh& detailed);

/// Vertex, cone, radius, mu and delta of every step; the balls are about `centers`.
///
/// With weights >= 0 that sum up to 1 a blend puts every vertex into the convex hull of where its
/// shapes have it, so a ball that holds these holds it. Cones hold what blended_normals.h says,
/// deviation spaces, which are convex, what NearestInShapes says.
///
/// `options.vertical` and `inside_triangles` are not for these. Returns false when cancelled.
bool measure_bounds_in_shapes(const DetailedMesh& detailed, const StepBoundsOptions& options,
                              const SequenceHistory* history, std::span<const Vec3> centers,
                              std::vector<StepBounds>& bounds);

}  // namespace varifold
