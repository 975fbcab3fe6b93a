// The vertex buffers of a mesh as those of a draw list.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/draw_list.h>

namespace varifold {

/// A list with the vertex attributes of `mesh`, which must outlive it, and nothing else.
[[nodiscard]] inline DrawList draw_vertices(const TriangleMesh& mesh) {
  DrawList list;
  list.positions = mesh.positions;
  list.normals = mesh.normals;
  list.texcoords = mesh.texcoords;
  list.colors = mesh.colors;
  list.skin = mesh.skin;
  list.poses = mesh.poses;
  return list;
}

}  // namespace varifold
