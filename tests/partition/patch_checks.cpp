#include <tests/partition/patch_checks.h>
#include <varifold/base/random.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/weld.h>
#include <algorithm>
#include <numeric>

namespace varifold::test {

namespace {

// The order of points along a curve that visits the cells of a grid, halving by halving.
std::vector<std::uint32_t> curve_order(const std::vector<Vec3>& positions) {
  Box box;
  for (const Vec3& p : positions) box.add(p);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    const Vec3 cell = (positions[i] - box.lower) / std::max(box.diagonal(), 1e-30f) * 1023.0f;
    std::uint64_t key = 0;
    for (int bit = 9; bit >= 0; --bit)
      for (int axis = 0; axis < 3; ++axis)
        key = key << 1 | ((static_cast<std::uint64_t>(cell[axis]) >> bit) & 1);
    keyed.emplace_back(key, i);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> order;
  for (const auto& [key, i] : keyed) order.push_back(i);
  return order;
}

TriangleMesh without_some_triangles(TriangleMesh mesh, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    if (random.below(8) != 0)
      kept.insert(kept.end(), mesh.indices.begin() + i, mesh.indices.begin() + i + 3);
  mesh.indices = kept;
  return mesh;
}

}  // namespace

TestSurface make_surface(const std::string& name, const TriangleMesh& mesh) {
  const WeldMap weld = weld_exact(mesh.positions);
  std::vector<Vec3> places(weld.class_count);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    places[weld.class_of[v]] = mesh.positions[v];
  const std::vector<std::uint32_t> order = curve_order(places);
  std::vector<std::uint32_t> number(order.size());
  TestSurface surface;
  surface.name = name;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    number[order[i]] = i;
    surface.positions.push_back(places[order[i]]);
  }
  const std::vector<std::uint32_t> materials = triangle_materials(mesh);
  std::vector<std::array<std::uint32_t, 5>> triangles;  // lowest corner, corners, material
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    std::array<std::uint32_t, 5> entry{};
    for (int i = 0; i < 3; ++i) entry[i + 1] = number[weld.class_of[mesh.indices[3 * t + i]]];
    if (entry[1] == entry[2] || entry[2] == entry[3] || entry[3] == entry[1]) continue;
    entry[0] = std::min({entry[1], entry[2], entry[3]});
    entry[4] = materials[t];
    triangles.push_back(entry);
  }
  std::stable_sort(triangles.begin(), triangles.end(),
                   [](const auto& a, const auto& b) { return a[0] < b[0]; });
  for (const auto& entry : triangles) {
    surface.corners.insert(surface.corners.end(), entry.begin() + 1, entry.begin() + 4);
    surface.materials.push_back(entry[4]);
  }
  if (mesh.ranges.empty()) surface.materials.clear();
  return surface;
}

std::vector<TestSurface> partition_surfaces() {
  std::vector<TestSurface> surfaces;
  for (const NamedMesh& named : all_groups())
    surfaces.push_back(make_surface(named.name, named.mesh));
  PlanetOptions rough;
  rough.triangles = 12'000;
  rough.seed = 7;
  surfaces.push_back(make_surface("planet", planet(rough)));
  surfaces.push_back(make_surface("perforated grid", without_some_triangles(grid(60, 50), 3)));
  surfaces.push_back(make_surface("perforated planet", without_some_triangles(planet(rough), 5)));
  surfaces.push_back(make_surface("long grid", grid(700, 3)));
  TriangleMesh many = grid(40, 40);
  for (int i = 0; i < 60; ++i)
    many = join(many, i % 3 == 0 ? octahedron() : grid(2, 1 + i % 4),
                Vec3(static_cast<float>(i % 8) * 5, static_cast<float>(i) / 2, 4));
  surfaces.push_back(make_surface("many components", many));
  TestSurface stripes = make_surface("stripes", grid(50, 40));
  for (std::size_t t = 0; t < stripes.corners.size() / 3; ++t)
    stripes.materials.push_back(
        static_cast<std::uint32_t>(stripes.positions[stripes.corners[3 * t]].x) / 3 % 4);
  surfaces.push_back(stripes);
  surfaces.push_back(make_surface("soup", soup(400, 1500, 11)));
  return surfaces;
}

std::map<Edge, std::vector<std::uint32_t>> triangles_of_edges(const TestSurface& surface) {
  std::map<Edge, std::vector<std::uint32_t>> edges;
  for (std::uint32_t t = 0; t < surface.corners.size() / 3; ++t)
    for (int i = 0; i < 3; ++i)
      edges[std::minmax({surface.corners[3 * t + i], surface.corners[3 * t + (i + 1) % 3]})]
          .push_back(t);
  return edges;
}

std::int64_t euler_of(const TestSurface& surface, const std::vector<std::uint32_t>& triangles) {
  std::set<std::uint32_t> points;
  std::set<Edge> edges;
  for (const std::uint32_t t : triangles)
    for (int i = 0; i < 3; ++i) {
      points.insert(surface.corners[3 * t + i]);
      edges.insert(std::minmax({surface.corners[3 * t + i], surface.corners[3 * t + (i + 1) % 3]}));
    }
  return static_cast<std::int64_t>(points.size()) - static_cast<std::int64_t>(edges.size()) +
         static_cast<std::int64_t>(triangles.size());
}

std::vector<std::uint32_t> connected_parts(const TestSurface& surface,
                                           const std::vector<std::uint32_t>& label,
                                           bool through_nonmanifold) {
  std::vector<std::vector<std::uint32_t>> next(label.size());
  std::map<std::uint32_t, std::vector<std::uint32_t>> at_point;
  std::set<std::uint32_t> chain_points;
  for (const auto& [edge, triangles] : triangles_of_edges(surface)) {
    if (triangles.size() == 2) {
      next[triangles[0]].push_back(triangles[1]);
      next[triangles[1]].push_back(triangles[0]);
    } else if (triangles.size() > 2) {
      chain_points.insert({edge.first, edge.second});
    }
  }
  if (through_nonmanifold) {
    for (std::uint32_t h = 0; h < surface.corners.size(); ++h)
      if (chain_points.count(surface.corners[h])) at_point[surface.corners[h]].push_back(h / 3);
    for (const auto& [point, triangles] : at_point)
      for (const std::uint32_t a : triangles)
        for (const std::uint32_t b : triangles) next[a].push_back(b);
  }
  std::vector<std::uint32_t> part(label.size(), kNone), stack;
  for (std::uint32_t seed = 0; seed < label.size(); ++seed) {
    if (part[seed] != kNone) continue;
    part[seed] = seed;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (const std::uint32_t u : next[t])
        if (part[u] == kNone && label[u] == label[t]) {
          part[u] = seed;
          stack.push_back(u);
        }
    }
  }
  return part;
}

std::vector<std::vector<std::uint32_t>> triangles_by_label(const std::vector<std::uint32_t>& label,
                                                           std::uint32_t count) {
  std::vector<std::vector<std::uint32_t>> result(count);
  for (std::uint32_t t = 0; t < label.size(); ++t) result[label[t]].push_back(t);
  return result;
}

}  // namespace varifold::test
