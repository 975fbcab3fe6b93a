#include <varifold/models/vdpm/view_dependent_mesh.h>

#include <varifold/mesh/vertex_arrays.h>
#include <algorithm>
#include <utility>

namespace varifold {

ViewDependentMesh::ViewDependentMesh(ViewDependentMeshData data) : data_(std::move(data)) {
  base_vertices_ = data_.levels.vertex_count(0);
  one_vertex_a_step_ = data_.mesh.vertex_count() - base_vertices_ == step_count();
  has_plain_centers_ = one_vertex_a_step_ && data_.centers.empty() && data_.first_look.empty();
  std::vector<const std::vector<Vec3>*> all{&data_.mesh.positions, &data_.placed.positions,
                                            &data_.centers};
  for (const Pose& pose : data_.mesh.poses) all.push_back(&pose.positions);
  Box box;
  for (const auto* positions : all)
    for (const Vec3& p : *positions) box.add(p);
  if (box.empty()) return;
  ball_.center = box.center();
  for (const auto* positions : all)
    for (const Vec3& p : *positions)
      ball_.radius = std::max(ball_.radius, glm::length(p - ball_.center) * (1 + 1e-6f));
}

const Vec3& ViewDependentMesh::other_center(std::uint32_t step) const {
  if (!data_.centers.empty()) return data_.centers[step];
  const std::uint32_t vertex = first_vertex(step);
  const std::uint32_t look = data_.first_look.empty() ? kNone : data_.first_look[vertex];
  return look == kNone ? data_.mesh.positions[vertex] : data_.placed.positions[look];
}

std::size_t ViewDependentMesh::bytes() const {
  const std::size_t words = data_.watch_roots.size() + data_.base_corners.size() +
                            data_.base_triangles.size() + data_.first_placed.size() +
                            data_.placed_vertex.size() + data_.finer.size() +
                            data_.first_look.size();
  return vertex_bytes(data_.mesh) + data_.levels.bytes() +
         data_.bounds.size() * sizeof(PackedBounds) + data_.centers.size() * sizeof(Vec3) +
         data_.records.bytes() + words * sizeof(std::uint32_t) + vertex_bytes(data_.placed);
}

}  // namespace varifold
