// Whether a mesh is one that can be simplified at all.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <span>
#include <string>

namespace varifold {

/// What of the mesh is inconsistent or not finite, in one line; empty where nothing is. O(n).
[[nodiscard]] std::string input_fault(const TriangleMesh& mesh);

/// The same for shapes beside the poses of the mesh. O(vertices * samples).
[[nodiscard]] std::string sample_fault(const TriangleMesh& mesh, std::span<const Pose> samples);

}  // namespace varifold
