// All arrays of a mesh that have one entry a vertex, so that code which copies, cuts or counts
// vertices need not name them.
#pragma once

#include <varifold/mesh/triangle_mesh.h>

namespace varifold {

/// Calls visit(array) for each, also for those that are empty.
template <class Mesh, class Visit>
void for_each_vertex_array(Mesh& mesh, const Visit& visit) {
  visit(mesh.positions);
  visit(mesh.normals);
  visit(mesh.texcoords);
  visit(mesh.colors);
  visit(mesh.skin);
  for (auto& pose : mesh.poses) {
    visit(pose.positions);
    visit(pose.normals);
  }
}

/// Gives `to` the poses of `from` by name, without places for vertices, and its rig.
inline void copy_pose_names(const TriangleMesh& from, TriangleMesh& to) {
  to.rig = from.rig;
  to.poses.clear();
  for (const Pose& pose : from.poses) to.poses.push_back({pose.name, {}, {}});
}

/// Calls visit(array of `from`, array of `to`) for each. They must have as many poses.
template <class Visit>
void for_each_vertex_array(const TriangleMesh& from, TriangleMesh& to, const Visit& visit) {
  visit(from.positions, to.positions);
  visit(from.normals, to.normals);
  visit(from.texcoords, to.texcoords);
  visit(from.colors, to.colors);
  visit(from.skin, to.skin);
  for (std::size_t i = 0; i < from.poses.size(); ++i) {
    visit(from.poses[i].positions, to.poses[i].positions);
    visit(from.poses[i].normals, to.poses[i].normals);
  }
}

/// The vertices `kept` of `from`, in that order, with all that belongs to them; no triangles, no
/// materials. O(kept).
[[nodiscard]] TriangleMesh gather_vertices(const TriangleMesh& from,
                                           const std::vector<std::uint32_t>& kept);

/// The first `count` vertices alone; triangles are left as they are.
void cut_vertices(TriangleMesh& mesh, std::uint32_t count);

/// Whether two vertices are at one point, as weld_points() has it.
[[nodiscard]] bool same_point(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b);

/// Whether all attributes but the places of two vertices are equal.
[[nodiscard]] bool equal_attributes(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b);

/// Whether vertices at one point may differ: in an attribute, or in the material of their
/// triangles.
[[nodiscard]] bool may_have_seams(const TriangleMesh& mesh);

/// Memory of all arrays, images and indices apart.
[[nodiscard]] std::size_t vertex_bytes(const TriangleMesh& mesh);

}  // namespace varifold
