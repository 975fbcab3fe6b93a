// Whether a mesh is one that can be simplified at all.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <string>

namespace varifold {

/// What of the mesh is inconsistent or not finite, in one line; empty where nothing is. O(n).
[[nodiscard]] std::string input_fault(const TriangleMesh& mesh);

}  // namespace varifold
