#include <varifold/simplify/legality.h>

#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <varifold/simplify/classify.h>

namespace varifold {
namespace {

struct Fixture {
  explicit Fixture(const TriangleMesh& mesh) {
    InputFaults faults;
    surface = build_surface(mesh, {.with_wedges = mesh.has_texcoords()}, faults);
  }
  [[nodiscard]] std::uint32_t point(std::uint32_t vertex) const {
    return surface.point_of_vertex[vertex];
  }
  [[nodiscard]] VertexKind kind(std::uint32_t vertex) const {
    return surface.points[point(vertex)].kind;
  }
  [[nodiscard]] Refusal test(std::uint32_t from, std::uint32_t onto) {
    return test_collapse(surface, point(from), point(onto), {});
  }
  WorkingSurface surface;
};

// Vertices of a 3 x 3 grid:   6 7 8
//                             3 4 5
//                             0 1 2
TriangleMesh flat_grid() {
  TriangleMesh mesh;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) mesh.positions.emplace_back(x, y, 0);
  for (std::uint32_t y = 0; y < 2; ++y)
    for (std::uint32_t x = 0; x < 2; ++x) {
      const std::uint32_t v = 3 * y + x;
      mesh.indices.insert(mesh.indices.end(), {v, v + 1, v + 4, v, v + 4, v + 3});
    }
  return mesh;
}

TEST(VertexKinds, OfAGrid) {
  const Fixture grid(flat_grid());
  EXPECT_EQ(grid.kind(4), VertexKind::kManifold);
  for (const std::uint32_t v : {0, 1, 2, 3, 5, 6, 7, 8})
    EXPECT_EQ(grid.kind(v), VertexKind::kBorder) << v;
}

TEST(VertexKinds, OfASeam) {
  TriangleMesh mesh = flat_grid();
  mesh.ranges = {{0, 0, 4}, {1, 4, 4}};  // lower and upper row
  mesh.materials.resize(2);
  mesh.texcoords.resize(9);
  const Fixture grid(mesh);
  EXPECT_EQ(grid.kind(4), VertexKind::kSeam);
  EXPECT_EQ(grid.kind(3), VertexKind::kCorner);
  EXPECT_EQ(grid.kind(1), VertexKind::kBorder);
}

TEST(VertexKinds, OfThreeSheets) {
  // Three strips of two squares each around the edge (0, 1, 2).
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}};
  for (const Vec3 side : {Vec3(1, 0, 0), Vec3(-1, 1, 0), Vec3(-1, -1, 0)}) {
    const std::uint32_t first = mesh.vertex_count();
    for (int z = 0; z < 3; ++z) mesh.positions.push_back(side + Vec3(0, 0, z));
    for (std::uint32_t z = 0; z < 2; ++z)
      mesh.indices.insert(mesh.indices.end(),
                          {z, first + z, first + z + 1, z, first + z + 1, z + 1});
  }
  Fixture book(mesh);
  EXPECT_EQ(book.kind(1), VertexKind::kNonManifold);
  EXPECT_EQ(book.kind(0), VertexKind::kLocked);  // three fans and four kinds of edges
  EXPECT_EQ(book.test(1, 0), Refusal::kLegal);
  EXPECT_EQ(book.test(1, 4), Refusal::kFixed);
}

TEST(VertexKinds, OfTwoTetrahedraThatShareAVertex) {
  TriangleMesh mesh = test::tetrahedron();
  TriangleMesh other = test::tetrahedron();
  for (Vec3& p : other.positions) p = 2.0f * mesh.positions[0] - p;  // mirrored at vertex 0
  for (std::size_t i = 0; i < other.indices.size(); i += 3)
    std::swap(other.indices[i], other.indices[i + 1]);
  const auto offset = mesh.vertex_count();
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const std::uint32_t v : other.indices) mesh.indices.push_back(v + offset);
  const Fixture bow_tie(mesh);
  EXPECT_EQ(bow_tie.kind(0), VertexKind::kLocked);
  EXPECT_EQ(bow_tie.kind(1), VertexKind::kManifold);
}

TEST(Legality, BordersCollapseAlongThemselves) {
  Fixture grid(flat_grid());
  EXPECT_EQ(grid.test(4, 1), Refusal::kLegal);
  EXPECT_EQ(grid.test(1, 4), Refusal::kFixed);
  EXPECT_EQ(grid.test(1, 0), Refusal::kLegal);
  EXPECT_EQ(grid.test(2, 1), Refusal::kLegal);  // an ear: one triangle, and it goes
}

TEST(Legality, KeepsTheLastTetrahedronAndTriangle) {
  Fixture tetrahedron(test::tetrahedron());
  for (std::uint32_t v = 1; v < 4; ++v) EXPECT_EQ(tetrahedron.test(0, v), Refusal::kTopology);
  TriangleMesh triangle;
  triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.indices = {0, 1, 2};
  Fixture single(triangle);
  EXPECT_EQ(single.test(0, 1), Refusal::kTopology);
}

TEST(Legality, KeepsAHandleOpen) {
  // A triangular prism without lids: the ring 0 1 2 is no face, so its edges must not collapse.
  TriangleMesh tube;
  for (int z = 0; z < 3; ++z)
    for (const Vec3 p : {Vec3(1, 0, 0), Vec3(-0.5f, 0.8f, 0), Vec3(-0.5f, -0.8f, 0)})
      tube.positions.push_back(p + Vec3(0, 0, z));
  for (std::uint32_t z = 0; z < 2; ++z)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = 3 * z + k, b = 3 * z + (k + 1) % 3;
      tube.indices.insert(tube.indices.end(), {a, b, b + 3, a, b + 3, a + 3});
    }
  Fixture prism(tube);
  EXPECT_EQ(prism.test(3, 4), Refusal::kTopology);
  EXPECT_EQ(prism.test(0, 1), Refusal::kTopology);  // would close the opening
}

TEST(Legality, RefusesFlips) {
  // Vertex 4 of the grid moved beyond the border of its star's kernel: onto 1 it would fold.
  TriangleMesh mesh = flat_grid();
  mesh.positions[4] = {1, 1, 0};
  mesh.positions[3] = {0.9f, 0.2f, 0};
  Fixture grid(mesh);
  EXPECT_EQ(grid.test(4, 0), Refusal::kNormal);
}

TEST(Legality, RefusesHighValence) {
  Fixture grid(flat_grid());
  EXPECT_EQ(test_collapse(grid.surface, grid.point(4), grid.point(1), {.max_valence = 5}),
            Refusal::kValence);
}

}  // namespace
}  // namespace varifold
