#include <varifold/measure/front_parts.h>

#include <varifold/mesh/normals.h>
#include <varifold/models/common/extract_level.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace varifold::check {

namespace {

std::vector<std::uint64_t> vertex_checksums(const TriangleMesh& mesh) {
  std::vector<std::uint64_t> sums(mesh.vertex_count());
  std::array<std::byte, 2 * sizeof(Vec3) + sizeof(Vec2) + sizeof(Color)> bytes{};
  for (std::size_t v = 0; v < sums.size(); ++v) {
    std::byte* end = bytes.data();
    const auto add = [&](const auto& attribute) {
      if (attribute.empty()) return;
      const auto value = std::as_bytes(std::span(&attribute[v], 1));
      end = std::copy(value.begin(), value.end(), end);
    };
    add(mesh.positions);
    add(mesh.normals);
    add(mesh.texcoords);
    add(mesh.colors);
    sums[v] = checksum({bytes.data(), end});
  }
  return sums;
}

}  // namespace

std::vector<PlacedTriangle> placed_triangles(const TriangleMesh& mesh) {
  const std::vector<std::uint64_t> sums = vertex_checksums(mesh);
  const std::vector<std::uint32_t> materials = triangle_materials(mesh);
  std::vector<PlacedTriangle> triangles(mesh.triangle_count());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t* const corners = &mesh.indices[3 * t];
    const std::uint64_t a = sums[corners[0]], b = sums[corners[1]], c = sums[corners[2]];
    const std::uint64_t material = materials[t];
    triangles[t] = std::min({PlacedTriangle{a, b, c, material}, PlacedTriangle{b, c, a, material},
                             PlacedTriangle{c, a, b, material}});
  }
  return triangles;
}

std::vector<PlacedTriangle> sorted(std::vector<PlacedTriangle> triangles) {
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

TriangleMesh drawn_mesh(const TriangleMesh& attributes, const DrawList& list) {
  return extract_level(attributes, static_cast<std::uint32_t>(list.positions.size()), list);
}

bool draws_attributes(const TriangleMesh& attributes, const DrawList& list) {
  return list.positions.data() == attributes.positions.data() &&
         list.positions.size() == attributes.positions.size();
}

std::vector<std::uint32_t> ancestors_in_front(const ModelPoints& points,
                                              const TriangleMesh& drawn) {
  const auto vertices = static_cast<std::uint32_t>(points.point_of.size());
  // All vertices of a point come and go together.
  std::vector<bool> is_there(points.all().class_count, false);
  for (const std::uint32_t v : drawn.indices) is_there[points.point_of[v]] = true;
  std::vector<std::uint32_t> ancestor(vertices);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const std::uint32_t target = points.target[v];
    ancestor[v] = target == kNone || is_there[points.point_of[v]] ? v : ancestor[target];
  }
  return ancestor;
}

std::uint32_t count_zero_area(const TriangleMesh& mesh) {
  std::uint32_t count = 0;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    count += triangle_area(mesh, t) > 0 ? 0 : 1;
  return count;
}

bool has_all_asked_for(const SeededFront& front, const TriangleMesh& full,
                       const std::vector<PlacedTriangle>& placed,
                       const std::vector<PlacedTriangle>& found) {
  // Criteria are judged in floats.
  float reach = 0;
  for (const Vec3& p : full.positions)
    reach = std::max({reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  for (std::uint32_t t = 0; t < full.triangle_count(); ++t) {
    const std::uint32_t* const c = &full.indices[3 * std::size_t{t}];
    const std::array<Vec3, 3> corners{full.positions[c[0]], full.positions[c[1]],
                                      full.positions[c[2]]};
    if (front.asks_for(corners, 1e-5f * reach) &&
        !std::binary_search(found.begin(), found.end(), placed[t]))
      return false;
  }
  return true;
}

}  // namespace varifold::check
