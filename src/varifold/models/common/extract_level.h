// From what is drawn back to a mesh of its own.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/draw_list.h>
#include <cstdint>

namespace varifold {

/// The triangles of a draw list, those of strips without the degenerate ones, as a mesh whose
/// vertices are the first `vertex_count` of the list. Materials, images and the rig are
/// those of `attributes`; ranges are sorted by material.
/// O(vertices + indices).
[[nodiscard]] TriangleMesh extract_level(const TriangleMesh& attributes, std::uint32_t vertex_count,
                                         const DrawList& list);

}  // namespace varifold
