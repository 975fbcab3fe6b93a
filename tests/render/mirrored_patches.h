// What the vertex shader of patches draws, on the processor.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/patch_draws.h>
#include <varifold/view/patch_morph.h>
#include <optional>

namespace varifold::test {

/// Every corner a vertex of its own; with normals where nothing blends.
inline TriangleMesh mirrored_patches(const PatchDrawList& list,
                                     const std::optional<PatchMorphRange>& morph) {
  TriangleMesh mesh;
  for (const PatchDrawCommand& draw : list.draws)
    for (std::size_t i = draw.first_index; i < draw.first_index + draw.index_count; ++i) {
      const std::uint32_t own = draw.first_vertex + list.indices[i];
      const std::uint32_t v = switched_vertex(own, list.remap[own], draw.parent_vertex, draw.mask);
      mesh.indices.push_back(mesh.vertex_count());
      mesh.positions.push_back(morph ? morphed_position(list, v, *morph) : list.positions[v]);
      if (!list.normals.empty() && !morph) mesh.normals.push_back(list.normals[v]);
    }
  return mesh;
}

}  // namespace varifold::test
