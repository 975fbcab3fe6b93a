#include <varifold/mesh/vertex_arrays.h>

#include <algorithm>

namespace varifold {

TriangleMesh gather_vertices(const TriangleMesh& from, const std::vector<std::uint32_t>& kept) {
  TriangleMesh to;
  copy_pose_names(from, to);
  for_each_vertex_array(from, to, [&](const auto& values, auto& result) {
    if (values.empty()) return;
    result.reserve(kept.size());
    for (const std::uint32_t v : kept) result.push_back(values[v]);
  });
  return to;
}

void cut_vertices(TriangleMesh& mesh, std::uint32_t count) {
  for_each_vertex_array(mesh, [&](auto& values) {
    if (!values.empty()) values.resize(count);
  });
}

bool same_point(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b) {
  return mesh.positions[a] == mesh.positions[b] &&
         (!mesh.has_skin() || mesh.skin[a] == mesh.skin[b]) &&
         std::all_of(mesh.poses.begin(), mesh.poses.end(),
                     [&](const Pose& pose) { return pose.positions[a] == pose.positions[b]; });
}

bool equal_attributes(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b) {
  const auto same = [&](const auto& values) { return values.empty() || values[a] == values[b]; };
  return same(mesh.normals) && same(mesh.texcoords) && same(mesh.colors) && same(mesh.skin) &&
         std::all_of(mesh.poses.begin(), mesh.poses.end(),
                     [&](const Pose& pose) { return same(pose.normals); });
}

bool may_have_seams(const TriangleMesh& mesh) {
  return mesh.has_normals() || mesh.has_texcoords() || mesh.has_colors() ||
         mesh.ranges.size() > 1 ||
         std::any_of(mesh.poses.begin(), mesh.poses.end(),
                     [](const Pose& pose) { return !pose.normals.empty(); });
}

std::size_t vertex_bytes(const TriangleMesh& mesh) {
  std::size_t sum = 0;
  for_each_vertex_array(mesh,
                        [&](const auto& values) { sum += values.size() * sizeof(values[0]); });
  return sum;
}

}  // namespace varifold
