#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <varifold/strip/adjacency.h>
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace varifold {
namespace {

// The definition, word for word.
std::vector<std::uint32_t> by_definition(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> edges;
  const auto begin_of = [&](std::uint32_t h) { return mesh.indices[h]; };
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (is_degenerate(mesh.indices, t)) continue;
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h)
      edges[std::minmax(mesh.indices[h], mesh.indices[next_half_edge(h)])].push_back(h);
  }
  std::vector<std::uint32_t> across(mesh.indices.size(), kNone);
  const std::vector<std::uint32_t> materials = triangle_materials(mesh);
  for (const auto& [edge, half_edges] : edges) {
    if (half_edges.size() != 2) continue;
    const std::uint32_t a = half_edges[0], b = half_edges[1];
    if (begin_of(a) == begin_of(b) || materials[a / 3] != materials[b / 3]) continue;
    across[a] = b;
    across[b] = a;
  }
  return across;
}

TEST(Adjacency, IsAsDefinedOnAllMeshes) {
  for (const auto& [name, mesh] : test::all_groups())
    EXPECT_EQ(edge_adjacency(mesh), by_definition(mesh)) << name;
}

TEST(Adjacency, OfTwoTriangles) {
  //  2---3
  //  | \ |
  //  0---1
  const TriangleMesh mesh =
      test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 1, 2, 2, 1, 3});
  const std::vector<std::uint32_t> expected{kNone, 3, kNone, 1, kNone, kNone};
  EXPECT_EQ(edge_adjacency(mesh), expected);
}

TEST(Adjacency, StopsWhereTheMaterialChanges) {
  TriangleMesh mesh =
      test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 1, 2, 2, 1, 3});
  mesh.materials.resize(2);
  set_triangle_materials(mesh, {0, 1});
  EXPECT_EQ(edge_adjacency(mesh), std::vector<std::uint32_t>(6, kNone));
}

}  // namespace
}  // namespace varifold
