// Which shapes of a mesh are heeded when its levels are made.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <span>
#include <vector>

namespace varifold {

/// Shapes beside that at rest. Errors and bounds are measured in all of them.
struct PoseUse {
  bool orders = true;  ///< they order the collapses, too, and say what is legal
  /// More than TriangleMesh::poses: what a skin does, for example. They are no part of the result.
  /// A place for each vertex of the mesh; normals are not looked at.
  std::span<const Pose> samples;
};

/// The places of the mesh's poses, then those of the samples.
[[nodiscard]] inline std::vector<std::span<const Vec3>> other_shapes(
    const TriangleMesh& mesh, std::span<const Pose> samples) {
  std::vector<std::span<const Vec3>> shapes;
  for (const Pose& pose : mesh.poses) shapes.emplace_back(pose.positions);
  for (const Pose& pose : samples) shapes.emplace_back(pose.positions);
  return shapes;
}

}  // namespace varifold
