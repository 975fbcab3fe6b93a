#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/normals.h>
#include <varifold/mesh/topology.h>
#include <varifold/morph/repair_sphere.h>
#include <varifold/morph/sphere_surface.h>
#include <cmath>

namespace varifold {
namespace {

TEST(RepairSphere, LeavesSpheresAlone) {
  for (const TriangleMesh& mesh : {test::octahedron(), test::icosphere(80)}) {
    const auto repaired = repair_to_sphere(mesh);
    ASSERT_TRUE(repaired);
    EXPECT_FALSE(repaired->report.changed());
    EXPECT_EQ(repaired->mesh.triangle_count(), mesh.triangle_count());
  }
}

TEST(RepairSphere, ClosesHolesAndDropsParts) {
  TriangleMesh mesh = test::join(test::icosphere(320), test::tetrahedron(), {5, 0, 0});
  mesh.indices.erase(mesh.indices.begin(), mesh.indices.begin() + 3);
  mesh.indices.erase(mesh.indices.begin() + 300, mesh.indices.begin() + 303);
  ASSERT_FALSE(as_sphere(mesh, "m"));
  const auto repaired = repair_to_sphere(mesh);
  ASSERT_TRUE(repaired);
  EXPECT_EQ(repaired->report.closed_holes, 2u);
  EXPECT_EQ(repaired->report.dropped_components, 1u);
  EXPECT_EQ(repaired->report.component_triangles, 4u);
  EXPECT_TRUE(as_sphere(repaired->mesh, "m"));
}

TEST(RepairSphere, PartsWhatTouches) {
  // Two spheres in one mesh with a common vertex: the larger stays.
  TriangleMesh mesh = test::join(test::icosphere(320), test::icosphere(80), {2, 0, 0});
  const WeldMap weld = weld_within(mesh.positions, 0.05f);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    for (std::uint32_t w = 0; w < v; ++w)
      if (weld.class_of[v] == weld.class_of[w]) mesh.positions[v] = mesh.positions[w];
  const auto repaired = repair_to_sphere(mesh);
  ASSERT_TRUE(repaired);
  EXPECT_EQ(repaired->mesh.triangle_count(), 320u);
  EXPECT_TRUE(as_sphere(repaired->mesh, "m"));
}

TEST(RepairSphere, EveryGroupBecomesManifoldOrIsRefused) {
  for (const test::NamedMesh& named : test::all_groups()) {
    SCOPED_TRACE(named.name);
    const auto repaired = repair_to_sphere(named.mesh);
    if (!repaired) continue;
    const TopologyReport report =
        analyze_topology(repaired->mesh, weld_exact(repaired->mesh.positions));
    EXPECT_EQ(report.misoriented_edges, 0u);
    EXPECT_EQ(report.components, 1u);
  }
}

TEST(RepairSphere, TurnsWhatIsInsideOut) {
  const TriangleMesh outside = test::icosphere(80);
  TriangleMesh inside = outside;
  for (std::size_t t = 0; t < inside.indices.size(); t += 3)
    std::swap(inside.indices[t], inside.indices[t + 2]);
  const auto repaired = repair_to_sphere(inside);
  ASSERT_TRUE(repaired);
  EXPECT_TRUE(repaired->report.turned);
  EXPECT_GT(signed_volume(repaired->mesh), 0);
  EXPECT_DOUBLE_EQ(signed_volume(repaired->mesh), -signed_volume(inside));
  EXPECT_EQ(repaired->mesh.positions, outside.positions);
}

TEST(RepairSphere, CutsSmallHandlesAlone) {
  GeneratorOptions shape;
  shape.triangles = 1000;
  const TriangleMesh ring = torus(shape);
  const auto kept = repair_to_sphere(ring);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->report.cut_handles, 0u);
  EXPECT_FALSE(as_sphere(kept->mesh, "m"));
  RepairOptions all;
  all.max_handle = 10;
  // A lattice with many handles.
  const TriangleMesh sponge =
      test::voxels(3, [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return (x == 1) + (y == 1) + (z == 1) < 2;
      });
  for (const auto& [mesh, handles] : {std::pair(ring, 1u), std::pair(sponge, 5u)}) {
    const auto cut = repair_to_sphere(mesh, all);
    ASSERT_TRUE(cut);
    EXPECT_EQ(cut->report.cut_handles, handles);
    EXPECT_TRUE(as_sphere(cut->mesh, "m"));
  }
}

TEST(RepairSphere, KeepsTheLongestHoleOpenIfAsked) {
  TriangleMesh mesh = test::grid(12, 12);
  mesh.indices.erase(mesh.indices.begin() + 150, mesh.indices.begin() + 156);  // three triangles
  ASSERT_FALSE(as_sphere_or_disc(mesh, "m"));
  RepairOptions options;
  options.keep_longest_hole = true;
  options.max_hole_edges = 5;
  const auto repaired = repair_to_sphere(mesh, options);
  ASSERT_TRUE(repaired);
  EXPECT_EQ(repaired->report.closed_holes, 1u);
  EXPECT_EQ(repaired->report.open_edges, 48u);
  EXPECT_NEAR(repaired->report.openness, 48 / std::sqrt(4 * 3.14159265 * 144), 0.02);
  const auto disc = as_sphere_or_disc(repaired->mesh, "m");
  ASSERT_TRUE(disc) << disc.error().message;
  EXPECT_EQ(disc->boundary.size(), 48u);
  // Without a hole it does what it does.
  const auto sphere = repair_to_sphere(test::icosphere(80), options);
  ASSERT_TRUE(sphere);
  EXPECT_FALSE(sphere->report.changed());
  EXPECT_EQ(sphere->report.open_edges, 0u);
}

TEST(RepairSphere, EveryGroupHasOneHoleOrNone) {
  RepairOptions options;
  options.keep_longest_hole = true;
  for (const test::NamedMesh& named : test::all_groups()) {
    SCOPED_TRACE(named.name);
    const auto repaired = repair_to_sphere(named.mesh, options);
    if (!repaired) continue;
    const TopologyReport report =
        analyze_topology(repaired->mesh, weld_exact(repaired->mesh.positions));
    EXPECT_EQ(report.misoriented_edges, 0u);
    EXPECT_EQ(report.nonmanifold_edges, 0u);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.boundary_loops, repaired->report.open_edges > 0 ? 1u : 0u);
  }
}

TEST(RepairSphere, RealMeshes) {
  for (const char* name : {"bunny.ply", "cow.obj", "camel.ply"}) {
    VARIFOLD_REAL_MESH_OR_SKIP(path, name);
    const auto repaired = repair_to_sphere(read_mesh(path)->mesh);
    ASSERT_TRUE(repaired) << name;
    const auto sphere = as_sphere(repaired->mesh, name);
    EXPECT_TRUE(sphere) << sphere.error().message;
  }
}

}  // namespace
}  // namespace varifold
