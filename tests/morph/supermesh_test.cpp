#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/topology.h>
#include <varifold/mesh/validation.h>
#include <varifold/morph/supermesh.h>

namespace varifold {
namespace {

TriangleMesh shape_of(const TriangleMesh& mesh, bool moved) {
  TriangleMesh shape;
  shape.positions = moved ? mesh.poses[0].positions : mesh.positions;
  shape.indices = mesh.indices;
  return shape;
}

void expect_shape(const TriangleMesh& shape, const TriangleMesh& input, double tolerance) {
  DistanceOptions options;
  options.samples = 20'000;
  options.vertices = true;
  const SurfaceDistanceReport distance = surface_distance(shape, input, options);
  EXPECT_LE(distance.hausdorff, tolerance * distance.diagonal);
}

void expect_supermesh(const Supermesh& super, const TriangleMesh& a, const TriangleMesh& b,
                      double tolerance) {
  EXPECT_EQ(super.report.flipped_on_sphere, 0u);
  ASSERT_EQ(super.mesh.poses.size(), 1u);
  ASSERT_TRUE(is_sound(validate(super.mesh)));
  const TopologyReport topology = analyze_topology(super.mesh, weld_points(super.mesh));
  EXPECT_TRUE(topology.closed && topology.manifold() && topology.oriented());
  EXPECT_EQ(topology.euler_characteristic, 2);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.degenerate_triangles, 0u);
  expect_shape(shape_of(super.mesh, false), a, tolerance);
  expect_shape(shape_of(super.mesh, true), b, tolerance);
}

TriangleMesh rough_planet(std::uint32_t triangles, std::uint64_t seed) {
  PlanetOptions options;
  options.triangles = triangles;
  options.seed = seed;
  options.relief = 0.4f;
  return planet(options);
}

TEST(Supermesh, RawOverlayOfPlanets) {
  const TriangleMesh a = rough_planet(2000, 1), b = rough_planet(1500, 2);
  SupermeshOptions options;
  options.tolerance = 0;
  const auto super = build_supermesh(a, b, options);
  ASSERT_TRUE(super) << super.error().message;
  std::printf("crossings %u triangles %u\n", super->report.crossings, super->mesh.triangle_count());
  expect_supermesh(*super, a, b, 1e-6);
}

TEST(Supermesh, RealMeshes) {
  VARIFOLD_REAL_MESH_OR_SKIP(horse, "horse.ply");
  VARIFOLD_REAL_MESH_OR_SKIP(armadillo, "armadillo.ply");
  const TriangleMesh a = read_mesh(horse)->mesh, b = read_mesh(armadillo)->mesh;
  for (const double tolerance : {0.0, 5e-5}) {
    SupermeshOptions options;
    options.tolerance = tolerance;
    const auto super = build_supermesh(a, b, options);
    ASSERT_TRUE(super) << super.error().message;
    const SupermeshReport& r = super->report;
    std::printf("crossings %u overlay %u triangles %u of %u; embed %.2f align %.2f overlay %.2f reduce %.2f\n",
                r.crossings, r.overlay_triangles, super->mesh.triangle_count(),
                r.input_triangles[0] + r.input_triangles[1], r.embed_seconds, r.align_seconds,
                r.overlay_seconds, r.reduce_seconds);
    expect_supermesh(*super, a, b, 1e-4);
  }
}

}  // namespace
}  // namespace varifold
