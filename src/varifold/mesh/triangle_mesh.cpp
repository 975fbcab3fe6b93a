#include <varifold/mesh/triangle_mesh.h>

#include <varifold/mesh/vertex_arrays.h>
#include <algorithm>
#include <numeric>

namespace varifold {

Box bounds(const TriangleMesh& mesh) {
  Box box;
  for (const std::uint32_t v : mesh.indices) box.add(mesh.positions[v]);
  return box;
}

std::vector<std::uint32_t> triangle_materials(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> material_of(mesh.triangle_count(), 0);
  for (const MaterialRange& range : mesh.ranges)
    std::fill_n(material_of.begin() + range.first_triangle, range.triangle_count, range.material);
  return material_of;
}

void set_triangle_materials(TriangleMesh& mesh, const std::vector<std::uint32_t>& materials_of) {
  std::vector<std::uint32_t> order(mesh.triangle_count());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return materials_of[a] < materials_of[b];
  });

  std::vector<std::uint32_t> sorted;
  sorted.reserve(mesh.indices.size());
  mesh.ranges.clear();
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const std::uint32_t triangle = order[i];
    for (int corner = 0; corner < 3; ++corner)
      sorted.push_back(mesh.indices[3 * triangle + corner]);
    if (mesh.ranges.empty() || mesh.ranges.back().material != materials_of[triangle])
      mesh.ranges.push_back({materials_of[triangle], i, 0});
    ++mesh.ranges.back().triangle_count;
  }
  mesh.indices = std::move(sorted);
}

TriangleMesh without_unused_vertices(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> new_id(mesh.vertex_count(), kNone);
  for (const std::uint32_t v : mesh.indices) new_id[v] = 0;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (new_id[v] == kNone) continue;
    new_id[v] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(v);
  }

  TriangleMesh result = gather_vertices(mesh, kept);
  result.indices.reserve(mesh.indices.size());
  for (const std::uint32_t v : mesh.indices) result.indices.push_back(new_id[v]);
  result.ranges = mesh.ranges;
  result.materials = mesh.materials;
  result.images = mesh.images;
  return result;
}

}  // namespace varifold
