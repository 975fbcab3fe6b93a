#include <varifold/models/common/extract_level.h>

#include <algorithm>
#include <vector>

namespace varifold {

namespace {

void append_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                     std::vector<std::uint32_t>& indices) {
  if (a != b && b != c && c != a) indices.insert(indices.end(), {a, b, c});
}

void append_range(const DrawList& list, const DrawRange& range,
                  std::vector<std::uint32_t>& indices) {
  const auto all = list.indices.subspan(range.first_index, range.index_count);
  if (range.primitive == Primitive::kTriangles) {
    indices.insert(indices.end(), all.begin(), all.end());
    return;
  }
  std::size_t begin = 0;  // of the present strip
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] == kStripRestart) begin = i + 1;
    if (i < begin + 2) continue;
    const bool odd = (i - begin) % 2 == 1;
    append_triangle(all[i - (odd ? 1 : 2)], all[i - (odd ? 2 : 1)], all[i], indices);
  }
}

}  // namespace

TriangleMesh extract_level(const TriangleMesh& attributes, std::uint32_t vertex_count,
                           const DrawList& list) {
  TriangleMesh mesh;
  const auto prefix = [&](const auto& from, auto& to) {
    if (!from.empty()) to.assign(from.begin(), from.begin() + vertex_count);
  };
  mesh.rig = attributes.rig;
  mesh.poses.resize(list.poses.size());
  prefix(list.skin, mesh.skin);
  for (std::size_t i = 0; i < list.poses.size(); ++i) {
    mesh.poses[i].name = list.poses[i].name;
    prefix(list.poses[i].positions, mesh.poses[i].positions);
    prefix(list.poses[i].normals, mesh.poses[i].normals);
  }
  prefix(list.positions, mesh.positions);
  prefix(list.normals, mesh.normals);
  prefix(list.texcoords, mesh.texcoords);
  prefix(list.colors, mesh.colors);
  mesh.materials = attributes.materials;
  mesh.images = attributes.images;

  std::vector<DrawRange> ranges(list.ranges.begin(), list.ranges.end());
  std::stable_sort(ranges.begin(), ranges.end(),
                   [](const DrawRange& a, const DrawRange& b) { return a.material < b.material; });
  for (const DrawRange& range : ranges) {
    const std::uint32_t before = mesh.triangle_count();
    append_range(list, range, mesh.indices);
    const std::uint32_t added = mesh.triangle_count() - before;
    if (attributes.ranges.empty() || added == 0) continue;
    if (!mesh.ranges.empty() && mesh.ranges.back().material == range.material)
      mesh.ranges.back().triangle_count += added;
    else
      mesh.ranges.push_back({range.material, before, added});
  }
  return mesh;
}

}  // namespace varifold
