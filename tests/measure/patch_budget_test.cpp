// Fronts of patch trees for a number of triangles, measured against whole levels.
#include <gtest/gtest.h>
#include <tests/models/patch_tree/built_trees.h>
#include <tests/models/patch_tree/tree_of.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/topology.h>
#include <varifold/mesh/weld.h>
#include <varifold/models/patch_tree/instance.h>
#include <cmath>

namespace varifold {
namespace {

double hausdorff(const TriangleMesh& mesh, const TriangleMesh& original) {
  DistanceOptions options;
  options.samples = 20'000;
  options.vertices = true;
  return surface_distance(mesh, original, options).hausdorff;
}

bool closed(const TriangleMesh& mesh) {
  return analyze_topology(mesh, weld_exact(mesh.positions)).closed;
}

// The bounds are compared in instance_test.cpp; here is what they are bounds of: the distance to
// the front for a number of triangles against that to the finest level of no more.
void expect_nearer_than_levels(const TriangleMesh& mesh,
                               const std::shared_ptr<const PatchTree>& tree) {
  PatchTreeInstance instance(tree);
  instance.go_to_level(tree->finest_level());
  const TriangleMesh original = instance.extract();
  double of_levels = 0, of_fronts = 0;  // sums of logarithms
  for (std::uint32_t level = 0; level < tree->finest_level(); ++level) {
    instance.go_to_level(level);
    const double of_level = hausdorff(instance.extract(), original);
    for (const double part : {1.0, 1.4, 1.8}) {
      const auto budget = static_cast<std::uint32_t>(part * tree->triangle_count(level));
      instance.go_to_triangles(budget);
      const TriangleMesh front = instance.extract();
      EXPECT_LE(front.triangle_count(), budget);
      if (closed(mesh)) {
        EXPECT_TRUE(closed(front));
      }
      const double of_front = hausdorff(front, original);
      EXPECT_LE(of_front, 1.3 * of_level) << level << " " << part;
      of_levels += std::log(of_level);
      of_fronts += std::log(of_front);
    }
  }
  EXPECT_LT(of_fronts, of_levels - 0.05 * tree->finest_level());
}

TEST(PatchBudget, FrontsAreNearerThanLevels) {
  for (const char* const name : {"blob of patches of 40", "seams of patches of 60"}) {
    SCOPED_TRACE(name);
    const test::BuiltTree& built = test::built_tree(name);
    expect_nearer_than_levels(built.mesh, built.tree);
  }
}

TEST(PatchBudget, DetailGoesWhereTheSurfaceIsRough) {
  TriangleMesh mesh = plane({.triangles = 8000});
  mesh.normals.clear();
  mesh.texcoords.clear();
  for (Vec3& p : mesh.positions)
    if (p.x > 0) p.y += 0.05f * std::sin(40 * p.x) * std::sin(50 * p.z);
  expect_nearer_than_levels(mesh, test::tree_of(mesh, 40));
}

TEST(PatchBudget, OfArmadillo) {
  VARIFOLD_REAL_MESH_OR_SKIP(path, "armadillo.ply");
  const auto read = read_mesh(path);
  ASSERT_TRUE(read);
  expect_nearer_than_levels(read->mesh, test::tree_of(read->mesh, 40));
}

}  // namespace
}  // namespace varifold
