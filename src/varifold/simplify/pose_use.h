// Which shapes of a mesh are heeded when its levels are made.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <span>
#include <vector>

namespace varifold {

/// Shapes beside that at rest. Errors and bounds are measured in all of them.
struct PoseUse {
  /// Whether TriangleMesh::poses, and the samples, order the collapses and say what is legal.
  bool poses_order = true, samples_order = true;
  /// More than TriangleMesh::poses: what a skin does, for example. They are no part of the result.
  /// A place for each vertex of the mesh; normals are not looked at.
  std::span<const Pose> samples;
};

/// The places of those that order the collapses: poses, then samples.
[[nodiscard]] inline std::vector<std::span<const Vec3>> ordering_shapes(const TriangleMesh& mesh,
                                                                        const PoseUse& use) {
  std::vector<std::span<const Vec3>> shapes;
  if (use.poses_order)
    for (const Pose& pose : mesh.poses) shapes.emplace_back(pose.positions);
  if (use.samples_order)
    for (const Pose& pose : use.samples) shapes.emplace_back(pose.positions);
  return shapes;
}

}  // namespace varifold
