// From a numbered mesh to its progressive mesh.
#pragma once

#include <varifold/models/pm/progressive_mesh.h>
#include <varifold/simplify/collapse_sequence.h>

namespace varifold {

/// One replay of the sequence; O(n) time. The triangles of the result are rotated so that the
/// corner that is newest when they appear comes first, and errors are rounded up to the two bytes
/// that files store (error_code.h). Limits of VertexSplit: a point has at most 255 wedges, and a
/// split at most 255 triangles and 65535 slots.
[[nodiscard]] ProgressiveMesh build_progressive_mesh(const DetailedMesh& detailed);

}  // namespace varifold
