// From a numbered mesh to its progressive mesh.
#pragma once

#include <varifold/models/pm/progressive_mesh.h>
#include <varifold/simplify/collapse_sequence.h>

namespace varifold {

/// One replay of the sequence. O(n) time; the triangles of the result are rotated so that their
/// newest corner comes first.
[[nodiscard]] ProgressiveMesh build_progressive_mesh(const DetailedMesh& detailed);

}  // namespace varifold
