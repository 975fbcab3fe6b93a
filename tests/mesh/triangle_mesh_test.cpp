#include <gtest/gtest.h>

#include <tests/support/meshes.h>
#include <varifold/mesh/triangle_mesh.h>

namespace varifold {
namespace {

using Indices = std::vector<std::uint32_t>;

TEST(Bounds, AroundUsedVerticesOnly) {
  const TriangleMesh mesh =
      test::make_mesh({{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 2, 0}}, {1, 2, 3});
  EXPECT_EQ(bounds(mesh).lower, Vec3(0));
  EXPECT_EQ(bounds(mesh).upper, Vec3(1, 2, 0));
  EXPECT_TRUE(bounds({}).empty());
}

TEST(TriangleMaterials, ThereAndBack) {
  TriangleMesh mesh = test::grid(2, 1);  // four triangles
  EXPECT_EQ(triangle_materials(mesh), (Indices{0, 0, 0, 0}));
  mesh.materials.resize(3);
  const Indices before = mesh.indices;
  set_triangle_materials(mesh, {2, 0, 2, 0});
  EXPECT_EQ(triangle_materials(mesh), (Indices{0, 0, 2, 2}));
  EXPECT_EQ(mesh.ranges, (std::vector<MaterialRange>{{0, 0, 2}, {2, 2, 2}}));
  // Stable: triangles 1, 3, 0, 2 of before.
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(mesh.indices[k], before[3 + k]);
    EXPECT_EQ(mesh.indices[3 + k], before[9 + k]);
    EXPECT_EQ(mesh.indices[6 + k], before[k]);
    EXPECT_EQ(mesh.indices[9 + k], before[6 + k]);
  }
}

TEST(WithoutUnusedVertices, KeepsOrderAndAttributes) {
  TriangleMesh mesh =
      test::make_mesh({{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {7, 7, 7}, {0, 2, 0}}, {4, 1, 2});
  mesh.colors = {{0, 0, 0, 0}, {1, 0, 0, 0}, {2, 0, 0, 0}, {3, 0, 0, 0}, {4, 0, 0, 0}};
  const TriangleMesh compact = without_unused_vertices(mesh);
  EXPECT_EQ(compact.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}));
  EXPECT_EQ(compact.indices, (Indices{2, 0, 1}));
  EXPECT_EQ(compact.colors, (std::vector<Color>{{1, 0, 0, 0}, {2, 0, 0, 0}, {4, 0, 0, 0}}));
  EXPECT_FALSE(compact.has_normals());
}

}  // namespace
}  // namespace varifold
