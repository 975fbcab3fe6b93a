#include <gtest/gtest.h>

#include <tests/support/meshes.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/normals.h>
#include <cmath>
#include <cstring>
#include <set>

namespace varifold {
namespace {

constexpr float kThird = 0.57735026919f;

void expect_near(const Vec3& a, const Vec3& b, float tolerance = 1e-6f) {
  EXPECT_LE(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " and " << b.x << " " << b.y << " " << b.z;
}

TEST(FaceNormal, OfARightTriangle) {
  const TriangleMesh mesh = test::make_mesh({{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}, {0, 1, 2, 0, 0, 1});
  EXPECT_EQ(area_vector(mesh, 0), DVec3(0, 0, 3));
  EXPECT_EQ(triangle_area(mesh, 0), 3);
  EXPECT_EQ(face_normal(mesh, 0), Vec3(0, 0, 1));
  EXPECT_EQ(face_normal(mesh, 1), Vec3(0));
  EXPECT_EQ(face_normals(mesh), (std::vector<Vec3>{{0, 0, 1}, {0, 0, 0}}));
  EXPECT_EQ(surface_area(mesh), 3);
}

TEST(FaceNormal, OfHugeAndTinyTriangles) {
  for (const float size : {1e-30f, 1e30f}) {
    const TriangleMesh mesh = test::make_mesh({{0, 0, 0}, {size, 0, 0}, {0, size, 0}}, {0, 1, 2});
    EXPECT_EQ(face_normal(mesh, 0), Vec3(0, 0, 1));
  }
}

TEST(SignedVolume, OfACubeAnywhere) {
  TriangleMesh mesh = test::cube();
  EXPECT_EQ(signed_volume(mesh), 8);
  EXPECT_EQ(surface_area(mesh), 24);
  for (Vec3& p : mesh.positions) p += Vec3(1e6f, -2e6f, 3e6f);
  EXPECT_EQ(signed_volume(mesh), 8);
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    std::swap(mesh.indices[i], mesh.indices[i + 1]);
  EXPECT_EQ(signed_volume(mesh), -8);
  EXPECT_EQ(signed_volume({}), 0);
}

TEST(ComputeNormals, AnglesDoNotDependOnTheTriangulation) {
  // The diagonals of the cube's faces meet some corners and not others.
  TriangleMesh mesh = test::cube();
  compute_normals(mesh);
  for (std::uint32_t v = 0; v < 8; ++v)
    expect_near(mesh.normals[v], mesh.positions[v] * kThird, 1e-7f);
}

TEST(ComputeNormals, AreasDo) {
  TriangleMesh mesh = test::cube();
  compute_normals(mesh, {.weight = NormalWeight::kArea});
  int off = 0;
  for (std::uint32_t v = 0; v < 8; ++v) {
    EXPECT_NEAR(glm::length(mesh.normals[v]), 1, 1e-6);
    off += glm::length(mesh.normals[v] - mesh.positions[v] * kThird) > 0.01f ? 1 : 0;
  }
  EXPECT_GT(off, 0);
}

TEST(ComputeNormals, AgreeAcrossSeams) {
  TriangleMesh mesh = box({.triangles = 12});
  compute_normals(mesh);
  EXPECT_EQ(mesh.vertex_count(), 24u);
  for (std::uint32_t v = 0; v < 24; ++v) expect_near(mesh.normals[v], mesh.positions[v] * kThird);
}

TEST(ComputeNormals, UnusedAndDegenerateGetAUnitVector) {
  TriangleMesh mesh = test::make_mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}}, {0, 1, 2});
  compute_normals(mesh);
  for (const Vec3& n : mesh.normals) EXPECT_EQ(n, Vec3(0, 0, 1));
}

TEST(ComputeNormals, SheetsThatCancelTakeTheFirst) {
  TriangleMesh mesh = test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {0, 1, 2, 0, 2, 1});
  compute_normals(mesh);
  for (const Vec3& n : mesh.normals) EXPECT_EQ(n, Vec3(0, -1, 0));
}

TEST(ComputeNormals, CreasesSplitTheCube) {
  TriangleMesh mesh = test::cube();
  mesh.colors.assign(8, Color(1, 2, 3, 4));
  const TriangleMesh before = mesh;
  compute_normals(mesh, {.crease_degrees = 60});
  EXPECT_EQ(mesh.vertex_count(), 24u);
  EXPECT_EQ(mesh.colors.size(), 24u);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.indices[3 * t + k];
      EXPECT_EQ(mesh.normals[v], face_normal(mesh, t));
      EXPECT_EQ(mesh.positions[v], before.positions[before.indices[3 * t + k]]);
    }
}

TEST(ComputeNormals, AWideCreaseAngleSplitsNothing) {
  TriangleMesh smooth = test::cube(), creased = test::cube();
  compute_normals(smooth);
  compute_normals(creased, {.crease_degrees = 91});
  EXPECT_EQ(creased.vertex_count(), 8u);
  EXPECT_EQ(smooth.normals, creased.normals);
}

TEST(ComputeNormals, CreasesOnAllGroupsKeepTheSurface) {
  for (const auto& [name, mesh] : test::all_groups()) {
    SCOPED_TRACE(name);
    TriangleMesh creased = mesh;
    compute_normals(creased, {.crease_degrees = 30});
    ASSERT_EQ(creased.normals.size(), creased.positions.size());
    ASSERT_GE(creased.vertex_count(), mesh.vertex_count());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
      ASSERT_EQ(creased.positions[creased.indices[i]], mesh.positions[mesh.indices[i]]);
    for (const Vec3& n : creased.normals) ASSERT_NEAR(glm::length(n), 1, 1e-5);
    EXPECT_EQ(creased.has_texcoords() ? creased.texcoords.size() : creased.positions.size(),
              creased.positions.size());
  }
}

TEST(ComputeNormals, SameBytesForAnyNumberOfThreads) {
  TriangleMesh one = test::icosphere(50'000);
  TriangleMesh many = one;
  compute_normals(one, {.threads = 1});
  for (const int threads : {2, 3}) {
    compute_normals(many, {.threads = threads});
    EXPECT_EQ(
        std::memcmp(one.normals.data(), many.normals.data(), one.normals.size() * sizeof(Vec3)), 0);
  }
  for (std::size_t v = 0; v < one.normals.size(); ++v)
    ASSERT_LE(glm::length(one.normals[v] - one.positions[v]), 0.01f);
}

}  // namespace
}  // namespace varifold
