#include <varifold/models/vdpm/view_dependent_mesh.h>

#include <varifold/models/common/extract_level.h>

namespace varifold {

std::size_t ViewDependentMesh::bytes() const {
  const std::size_t words = data_.watch_roots.size() + data_.base_corners.size() +
                            data_.base_triangles.size() + data_.first_placed.size() +
                            data_.placed_vertex.size() + data_.finer.size() +
                            data_.first_look.size();
  return attribute_bytes(data_.mesh) + data_.levels.bytes() +
         data_.bounds.size() * sizeof(PackedBounds) + data_.records.bytes() +
         words * sizeof(std::uint32_t) + attribute_bytes(data_.placed);
}

}  // namespace varifold
