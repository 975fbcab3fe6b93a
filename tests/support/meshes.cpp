#include <tests/support/meshes.h>
#include <varifold/base/random.h>
#include <varifold/mesh/generators.h>
#include <algorithm>
#include <utility>

namespace varifold::test {

namespace {

using Indices = std::vector<std::uint32_t>;

/// Keeps the triangles of a mesh for which keep(centre) holds, and the vertices that they use.
template <class Keep>
TriangleMesh part(const TriangleMesh& mesh, const Keep& keep) {
  TriangleMesh result = mesh;
  result.indices.clear();
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    Vec3 centre(0);
    for (int k = 0; k < 3; ++k) centre += mesh.positions[mesh.indices[i + k]] / 3.0f;
    if (keep(centre))
      for (int k = 0; k < 3; ++k) result.indices.push_back(mesh.indices[i + k]);
  }
  return without_unused_vertices(result);
}

bool in_sponge(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  for (; x + y + z > 0; x /= 3, y /= 3, z /= 3)
    if ((x % 3 == 1) + (y % 3 == 1) + (z % 3 == 1) >= 2) return false;
  return true;
}

bool in_checkers(std::uint32_t x, std::uint32_t y, std::uint32_t z) { return (x + y + z) % 2 == 0; }

/// A ring of quads from an inner to an outer circle of `n` points.
TriangleMesh annulus(std::uint32_t n) {
  TriangleMesh mesh = sphere({.triangles = 4 * n});
  return part(mesh, [](const Vec3& c) { return c.y > -0.8f && c.y < 0.8f; });
}

/// A strip of `n` quads whose end is joined to its start, upside down.
TriangleMesh moebius_strip(std::uint32_t n) {
  TriangleMesh mesh = grid(n, 1);
  for (Vec3& p : mesh.positions) p.z = p.x * (static_cast<float>(n) - p.x);
  // Vertices 0..n are the lower row, n+1..2n+1 the upper one.
  for (std::uint32_t& v : mesh.indices) {
    if (v == n)
      v = n + 1;
    else if (v == 2 * n + 1)
      v = 0;
  }
  return without_unused_vertices(mesh);
}

TriangleMesh two_tetrahedra(const Indices& second) {
  return make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
                   [&] {
                     Indices indices{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
                     indices.insert(indices.end(), second.begin(), second.end());
                     return indices;
                   }());
}

/// `pages` squares around one spine.
TriangleMesh book(std::uint32_t pages) {
  std::vector<Vec3> positions{{0, 0, 0}, {0, 1, 0}};
  Indices indices;
  for (std::uint32_t i = 0; i < pages; ++i) {
    const float x = static_cast<float>(i) - 1.5f, z = i % 2 == 0 ? 1.0f : -1.0f;
    const std::uint32_t v = 2 + 2 * i;
    positions.insert(positions.end(), {{x, 0, z}, {x, 1, z}});
    indices.insert(indices.end(), {0, v, 1, 1, v, v + 1});
  }
  return make_mesh(positions, indices);
}

TriangleMesh with_triangles(TriangleMesh mesh, const Indices& more) {
  mesh.indices.insert(mesh.indices.end(), more.begin(), more.end());
  return mesh;
}

/// A grid in two colours, split along the line between them, and in two materials, split as well.
TriangleMesh patchwork() {
  const TriangleMesh whole = plane({.triangles = 200});
  const TriangleMesh left = part(whole, [](const Vec3& c) { return c.x < 0; });
  const TriangleMesh right = part(whole, [](const Vec3& c) { return c.x > 0; });
  TriangleMesh mesh = join(left, right, Vec3(0));
  mesh.colors.assign(mesh.vertex_count(), Color(200, 60, 40, 255));
  std::fill(mesh.colors.begin() + left.vertex_count(), mesh.colors.end(), Color(40, 60, 200, 128));
  mesh.materials.resize(2);
  mesh.materials[0].name = "near";
  mesh.materials[1].name = "far";
  Indices materials(mesh.triangle_count());
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    materials[t] = mesh.positions[mesh.indices[3 * t]].z < 0 ? 1 : 0;
  set_triangle_materials(mesh, materials);
  return mesh;
}

}  // namespace

TriangleMesh make_mesh(std::vector<Vec3> positions, std::vector<std::uint32_t> indices) {
  TriangleMesh mesh;
  mesh.positions = std::move(positions);
  mesh.indices = std::move(indices);
  return mesh;
}

TriangleMesh tetrahedron() {
  return make_mesh({{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}},
                   {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
}

TriangleMesh octahedron() {
  return make_mesh({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                   {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5});
}

TriangleMesh cube() {
  TriangleMesh mesh = voxels(1, [](std::uint32_t, std::uint32_t, std::uint32_t) { return true; });
  for (Vec3& p : mesh.positions) p = 2.0f * p - 1.0f;
  return mesh;
}

TriangleMesh icosphere(std::uint32_t triangles) {
  PlanetOptions options;
  options.triangles = triangles;
  options.relief = 0;
  return planet(options);
}

TriangleMesh grid(std::uint32_t columns, std::uint32_t rows) {
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= rows; ++y)
    for (std::uint32_t x = 0; x <= columns; ++x) mesh.positions.emplace_back(x, y, 0);
  for (std::uint32_t y = 0; y < rows; ++y)
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t a = y * (columns + 1) + x, b = a + columns + 1;
      mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  return mesh;
}

TriangleMesh voxels(std::uint32_t n, bool (*is_full)(std::uint32_t, std::uint32_t, std::uint32_t)) {
  const std::uint32_t side = n + 1;
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < side * side * side; ++i)
    mesh.positions.emplace_back(i % side, i / side % side, i / side / side);
  const auto full = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return x < n && y < n && z < n && is_full(x, y, z);  // below 0 wraps around
  };
  const std::uint32_t step[3] = {1, side, side * side};
  for (std::uint32_t z = 0; z < n; ++z)
    for (std::uint32_t y = 0; y < n; ++y)
      for (std::uint32_t x = 0; x < n; ++x) {
        if (!full(x, y, z)) continue;
        const std::uint32_t low = x + side * (y + side * z);
        for (int axis = 0; axis < 3; ++axis) {
          const std::uint32_t u = step[(axis + 1) % 3], v = step[(axis + 2) % 3];
          const std::uint32_t dx = axis == 0, dy = axis == 1, dz = axis == 2;
          const std::uint32_t a = low, b = low + step[axis];
          if (!full(x - dx, y - dy, z - dz))
            mesh.indices.insert(mesh.indices.end(), {a, a + u + v, a + u, a, a + v, a + u + v});
          if (!full(x + dx, y + dy, z + dz))
            mesh.indices.insert(mesh.indices.end(), {b, b + u, b + u + v, b, b + u + v, b + v});
        }
      }
  return without_unused_vertices(mesh);
}

TriangleMesh soup(std::uint32_t vertices, std::uint32_t triangles, std::uint64_t seed) {
  Random random(seed);
  const auto coordinate = [&] { return static_cast<float>(random.uniform()); };
  TriangleMesh mesh;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const float x = coordinate(), y = coordinate(), z = coordinate();
    mesh.positions.emplace_back(x, y, z);
  }
  while (mesh.triangle_count() < triangles) {
    const std::uint32_t a = random.below(vertices), b = random.below(vertices),
                        c = random.below(vertices);
    if (a != b && b != c && a != c) mesh.indices.insert(mesh.indices.end(), {a, b, c});
  }
  return mesh;
}

TriangleMesh join(const TriangleMesh& a, const TriangleMesh& b, const Vec3& offset) {
  TriangleMesh mesh;
  mesh.positions = a.positions;
  for (const Vec3& p : b.positions) mesh.positions.push_back(p + offset);
  if (a.has_normals() && b.has_normals()) {
    mesh.normals = a.normals;
    mesh.normals.insert(mesh.normals.end(), b.normals.begin(), b.normals.end());
  }
  if (a.has_texcoords() && b.has_texcoords()) {
    mesh.texcoords = a.texcoords;
    mesh.texcoords.insert(mesh.texcoords.end(), b.texcoords.begin(), b.texcoords.end());
  }
  mesh.indices = a.indices;
  for (const std::uint32_t v : b.indices) mesh.indices.push_back(v + a.vertex_count());
  return mesh;
}

std::vector<NamedMesh> group_closed() {
  return {{"tetrahedron", tetrahedron()},
          {"octahedron", octahedron()},
          {"cube", cube()},
          {"icosphere", icosphere(500)},
          {"planet", planet({{.triangles = 2000}, 0.12f, false})},
          {"sponge_genus_5", voxels(3, in_sponge)},
          {"sponge_genus_81", voxels(9, in_sponge)}};
}

std::vector<NamedMesh> group_open() {
  const auto outside_hole = [](const Vec3& c) {
    return !(c.x > 3 && c.x < 6 && c.y > 3 && c.y < 6);
  };
  return {{"grid", grid(8, 8)},
          {"narrow_grid", grid(12, 1)},
          {"punched_grid", part(grid(10, 9), outside_hole)},
          {"terrain", terrain({{.triangles = 800}, 0.15f})},
          {"ring", annulus(24)},
          {"half_sphere", part(icosphere(1300), [](const Vec3& c) { return c.z > 0.1f; })},
          {"planet_without_poles", part(planet({{.triangles = 2000}, 0.12f, false}),
                                        [](const Vec3& c) { return c.y * c.y < 0.8f; })}};
}

std::vector<NamedMesh> group_nonmanifold() {
  return {{"three_fins", make_mesh({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}},
                                   {0, 1, 2, 0, 1, 3, 0, 1, 4})},
          {"shared_vertex",
           without_unused_vertices(two_tetrahedra({0, 5, 4, 0, 4, 6, 0, 6, 5, 4, 5, 6}))},
          {"shared_edge",
           without_unused_vertices(two_tetrahedra({0, 3, 4, 0, 4, 5, 0, 5, 3, 3, 5, 4}))},
          {"book", book(5)},
          {"voxel_checkers", voxels(4, in_checkers)},
          {"cube_with_fin",
           with_triangles(join(cube(), make_mesh({{0, 0, 3}}, {}), Vec3(0)), {4, 7, 8})},
          {"grid_with_wall",
           with_triangles(join(grid(6, 6), make_mesh({{3, 2.5f, 2}}, {}), Vec3(0)), {17, 24, 49})}};
}

std::vector<NamedMesh> group_seams() {
  return {{"sharp_cube", box({.triangles = 12})},
          {"sharp_box", box({.triangles = 12 * 36})},
          {"uv_sphere", sphere({.triangles = 600})},
          {"seamed_sphere", seamed_sphere({.triangles = 800})},
          {"uv_torus", torus({.triangles = 600})},
          {"uv_knot", knot({{.triangles = 2000}, 2, 3})},
          {"patchwork", patchwork()}};
}

std::vector<NamedMesh> group_components() {
  TriangleMesh tetrahedra = tetrahedron();
  TriangleMesh loose = grid(1, 1);
  for (int i = 1; i < 12; ++i) {
    tetrahedra = join(tetrahedra, tetrahedron(), {3.0f * static_cast<float>(i), 0, 0});
    loose = join(loose, grid(1, 1), {0, 0, static_cast<float>(i)});
  }
  TriangleMesh inner = icosphere(320);
  for (Vec3& p : inner.positions) p *= 0.5f;
  TriangleMesh zoo = join(icosphere(500), grid(5, 4), {3, 0, 0});
  zoo = join(zoo, cube(), {-4, 0, 0});
  zoo = join(zoo, make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}), {0, 5, 0});
  return {{"twelve_tetrahedra", tetrahedra},
          {"loose_squares", loose},
          {"nested_spheres", join(icosphere(500), inner, Vec3(0))},
          {"zoo", zoo}};
}

std::vector<NamedMesh> group_tiny() {
  const std::vector<Vec3> five{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {-1, -1, 0}};
  const auto over = [&](std::size_t count, const Indices& indices) {
    return make_mesh({five.begin(), five.begin() + static_cast<std::ptrdiff_t>(count)}, indices);
  };
  return {{"empty", {}},
          {"one_vertex", over(1, {})},
          {"one_triangle", over(3, {0, 1, 2})},
          {"two_triangles", over(4, {0, 1, 2, 2, 1, 3})},
          {"back_to_back", over(3, {0, 1, 2, 0, 2, 1})},
          {"touching_triangles", without_unused_vertices(over(5, {0, 1, 3, 0, 4, 2}))}};
}

std::vector<NamedMesh> group_defects() {
  TriangleMesh unused = join(make_mesh({{9, 9, 9}, {8, 8, 8}}, {}), grid(3, 3), Vec3(0));
  unused.positions.emplace_back(7, 7, 7);
  TriangleMesh shuffled = cube();
  std::swap(shuffled.indices[0], shuffled.indices[1]);
  TriangleMesh degenerate = grid(3, 3);
  degenerate.positions[5] = degenerate.positions[6];
  return {{"unused_vertices", unused},
          {"duplicates", with_triangles(grid(3, 3), {0, 1, 5, 1, 5, 0, 5, 1, 0})},
          {"repeated_corners", with_triangles(grid(3, 3), {0, 0, 1, 2, 2, 2})},
          {"collapsed_by_position", degenerate},
          {"one_triangle_turned", shuffled},
          {"moebius_strip", moebius_strip(9)},
          {"soup", soup(40, 120, 1)},
          {"dense_soup", soup(9, 60, 2)},
          {"sparse_soup", soup(300, 120, 3)}};
}

std::vector<NamedMesh> all_groups() {
  std::vector<NamedMesh> all;
  for (auto group : {group_closed, group_open, group_nonmanifold, group_seams, group_components,
                     group_tiny, group_defects})
    for (NamedMesh& named : group()) all.push_back(std::move(named));
  return all;
}

}  // namespace varifold::test
