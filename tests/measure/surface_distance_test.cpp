#include <gtest/gtest.h>

#include <tests/support/meshes.h>
#include <varifold/base/random.h>
#include <varifold/measure/closest_point.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/generators.h>
#include <cmath>
#include <limits>

namespace varifold {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TriangleMesh moved(TriangleMesh mesh, const Vec3& offset) {
  for (Vec3& p : mesh.positions) p += offset;
  return mesh;
}

TEST(SurfaceDistance, OfACubeIsExact) {
  const SurfaceDistance cube(test::cube());
  EXPECT_EQ(cube.distance({0, 0, 0}), 1);
  EXPECT_EQ(cube.distance({3, 0, 0}), 2);
  EXPECT_EQ(cube.distance({2, 2, 0}), std::sqrt(2.0));
  const ClosestPoint found = cube.closest({0.25, 0.5, 1.5});
  EXPECT_EQ(found.point, DVec3(0.25, 0.5, 1));
  EXPECT_EQ(found.distance, 0.5);
  EXPECT_LT(found.triangle, 12u);
}

TEST(SurfaceDistance, NamesTheFirstOfEquals) {
  TriangleMesh mesh = test::grid(1, 1);
  for (int copy = 0; copy < 50; ++copy)
    for (std::size_t i = 0; i < 6; ++i) mesh.indices.push_back(std::uint32_t{mesh.indices[i]});
  const SurfaceDistance squares(mesh);
  EXPECT_EQ(squares.closest({0.9, 0.1, 1}).triangle, 0u);
  EXPECT_EQ(squares.closest({0.1, 0.9, 1}).triangle, 1u);
  EXPECT_EQ(squares.closest({0.5, 0.5, -1}).triangle, 0u);
}

TEST(SurfaceDistance, OfNothingIsInfinite) {
  const SurfaceDistance nothing{TriangleMesh{}};
  EXPECT_TRUE(nothing.empty());
  EXPECT_EQ(nothing.distance({0, 0, 0}), kInfinity);
  EXPECT_EQ(nothing.closest({0, 0, 0}).triangle, kNone);
}

TEST(SurfaceDistance, AgreesWithBruteForceNearAndFar) {
  const TriangleMesh mesh = test::soup(100, 150, 6);
  const SurfaceDistance tree(mesh);
  Random random(1);
  for (const double range : {0.1, 1.0, 10.0, 1e6})
    for (int i = 0; i < 100; ++i) {
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      const DVec3 p = range * (2.0 * DVec3(x, y, z) - 1.0);
      double best = kInfinity;
      for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const auto corner = [&](std::size_t k) {
          return DVec3(mesh.positions[mesh.indices[t + k]]);
        };
        best = std::min(best,
                        glm::length(closest_on_triangle(p, corner(0), corner(1), corner(2)) - p));
      }
      const ClosestPoint found = tree.closest(p);
      ASSERT_NEAR(found.distance, best, 1e-13 * (1 + range));
      ASSERT_NEAR(glm::length(found.point - p), best, 1e-13 * (1 + range));
    }
}

TEST(SurfaceDistance, HugeTinyAndDistantModels) {
  for (const float size : {1e-20f, 1.0f, 1e20f}) {
    TriangleMesh mesh = test::cube();
    for (Vec3& p : mesh.positions) p *= size;
    EXPECT_NEAR(SurfaceDistance(mesh).distance(DVec3(3.0 * size, 0, 0)) / size, 2, 1e-6);
  }
  const SurfaceDistance far_away(moved(test::cube(), {4e6f, 0, -4e6f}));
  EXPECT_NEAR(far_away.distance({4e6 + 1.001, 0, -4e6}), 0.001, 1e-9);
}

TEST(SurfaceDistance, VerticesOfAMeshAreOnIt) {
  const TriangleMesh mesh = planet({{.triangles = 5000}, 0.12f, false});
  const SurfaceDistance tree(mesh);
  for (const Vec3& p : mesh.positions) ASSERT_LE(tree.distance(DVec3(p)), 1e-15);
}

TEST(SurfaceDistanceReport, ParallelSquares) {
  const TriangleMesh a = test::grid(1, 1);
  const SurfaceDistanceReport report = surface_distance(a, moved(a, {0, 0, 0.25f}));
  EXPECT_NEAR(report.rms, 0.25, 1e-14);
  EXPECT_NEAR(report.hausdorff, 0.25, 1e-14);
  EXPECT_EQ(report.samples, 200'000u);
  EXPECT_DOUBLE_EQ(report.diagonal, std::sqrt(2.0));
}

TEST(SurfaceDistanceReport, IsTwoSided) {
  // A unit square and a strip of four: half of the strip's points lie x beyond the square, x
  // uniform up to 3, so the mean square is 3/4 * 3^2 / 3.
  const SurfaceDistanceReport report = surface_distance(test::grid(1, 1), test::grid(4, 1));
  EXPECT_LE(report.max_a_to_b, 1e-15);
  EXPECT_NEAR(report.rms_b_to_a, std::sqrt(2.25), 1e-3);
  EXPECT_NEAR(report.max_b_to_a, 3, 1e-3);
  EXPECT_EQ(report.rms, report.rms_b_to_a);
  EXPECT_EQ(report.hausdorff, report.max_b_to_a);
  EXPECT_EQ(surface_distance(test::grid(1, 1), test::grid(4, 1), {.vertices = true}).max_b_to_a, 3);
}

TEST(SurfaceDistanceReport, ConcentricSpheres) {
  TriangleMesh inner = test::icosphere(5'000), outer = inner;
  for (Vec3& p : outer.positions) p *= 1.1f;
  const SurfaceDistanceReport report = surface_distance(inner, outer, {.samples = 20'000});
  EXPECT_NEAR(report.rms, 0.1, 2e-3);
}

TEST(SurfaceDistanceReport, EmptyMeshes) {
  const TriangleMesh cube = test::cube();
  EXPECT_EQ(surface_distance({}, {}).rms, 0);
  const SurfaceDistanceReport report = surface_distance(cube, {}, {.samples = 10});
  EXPECT_EQ(report.rms_a_to_b, kInfinity);
  EXPECT_EQ(report.rms_b_to_a, 0);
  EXPECT_EQ(report.hausdorff, kInfinity);
  EXPECT_EQ(surface_distance({}, cube, {.samples = 10}).rms_b_to_a, kInfinity);
  EXPECT_EQ(surface_distance(cube, cube, {.samples = 0}).rms, 0);
}

TEST(SurfaceDistanceReport, MeshesWithoutArea) {
  const TriangleMesh line = test::make_mesh({{0, 0, 0}, {1, 0, 0}}, {0, 1, 0, 0, 0, 0});
  const SurfaceDistanceReport report =
      surface_distance(line, moved(line, {0, 2, 0}), {.samples = 100});
  EXPECT_NEAR(report.rms, 2, 1e-14);
  EXPECT_NEAR(report.hausdorff, 2, 1e-14);
}

TEST(SurfaceDistanceReport, AllGroupsAreAtNoDistanceFromThemselves) {
  for (const auto& [name, mesh] : test::all_groups()) {
    const SurfaceDistanceReport report = surface_distance(mesh, mesh, {.samples = 2000});
    EXPECT_LE(report.hausdorff, 1e-12) << name;
  }
}

TEST(SurfaceDistanceReport, SameBytesForAnyNumberOfThreads) {
  const TriangleMesh a = planet({{.triangles = 20'000}, 0.12f, false});
  const TriangleMesh b = planet({{.triangles = 4'000}, 0.12f, false});
  const SurfaceDistanceReport one = surface_distance(a, b, {.samples = 20'000, .threads = 1});
  for (const int threads : {2, 3, 0}) {
    const SurfaceDistanceReport many =
        surface_distance(a, b, {.samples = 20'000, .threads = threads});
    EXPECT_TRUE(one == many) << threads;
  }
  const SurfaceDistanceReport other = surface_distance(a, b, {.samples = 20'000, .seed = 2});
  EXPECT_NE(one.rms, other.rms);
  EXPECT_NEAR(one.rms, other.rms, 0.01 * one.rms);
}

}  // namespace
}  // namespace varifold
