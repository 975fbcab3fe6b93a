#include <varifold/render/mesh_draw_list.h>

#include <varifold/view/draw_vertices.h>

namespace varifold {

MeshDrawList::MeshDrawList(const TriangleMesh& mesh) : mesh_(&mesh) {
  for (const MaterialRange& range : mesh.ranges) {
    DrawRange drawn;
    drawn.first_index = 3 * range.first_triangle;
    drawn.index_count = 3 * range.triangle_count;
    drawn.material = range.material;
    ranges_.push_back(drawn);
  }
  if (mesh.ranges.empty()) {
    DrawRange whole;
    whole.index_count = 3 * mesh.triangle_count();
    ranges_.push_back(whole);
  }
  for (const Material& material : mesh.materials) material_colors_.push_back(material.base_color);
}

DrawList MeshDrawList::list() const {
  DrawList list = draw_vertices(*mesh_);
  list.indices = mesh_->indices;
  list.ranges = ranges_;
  return list;
}

}  // namespace varifold
