#include <gtest/gtest.h>
#include <tests/models/patch_tree/tree_fronts.h>
#include <tests/support/meshes.h>
#include <tests/support/test_files.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/weld.h>
#include <varifold/models/patch_tree/build.h>
#include <varifold/models/patch_tree/extract.h>
#include <algorithm>
#include <memory>

namespace varifold {
namespace {

PatchTreeBuild build(const TriangleMesh& mesh, std::uint32_t triangles, int threads = 1) {
  PatchTreeOptions options;
  options.triangles_per_patch = triangles;
  options.threads = threads;
  auto result = build_patch_tree(mesh, options);
  EXPECT_TRUE(result.has_value());
  return std::move(*result);
}

// The mesh without what a build leaves out: degenerate and repeated triangles, unused vertices.
TopologyReport topology_of_leaves(const PatchTree& tree) {
  const auto& topology = tree.topology();
  const TriangleMesh leaves =
      extract_front(tree, test::uniform_front(topology, topology.level_count() - 1));
  return analyze_topology(leaves, weld_exact(leaves.positions), 1);
}

TEST(PatchTreeBuild, EveryFrontOfEveryGroupIsSound) {
  for (const auto& [name, mesh] : test::all_groups()) {
    for (const std::uint32_t triangles : {4u, 16u, 100u}) {
      SCOPED_TRACE(name + " " + std::to_string(triangles));
      const PatchTreeBuild built = build(mesh, triangles);
      const PatchTopology& topology = built.tree.topology();
      if (topology.node_count() == 0) continue;
      const TopologyReport whole = topology_of_leaves(built.tree);
      const TopologyReport input = analyze_topology(mesh, weld_exact(mesh.positions), 1);
      EXPECT_EQ(whole.euler_characteristic,
                input.euler_characteristic - built.report.faults.duplicate_triangles);
      EXPECT_EQ(whole.boundary_edges, input.boundary_edges);
      Random random(triangles);
      for (int i = 0; i < 60; ++i) {
        const test::SplitNodes front = test::random_front(topology, random);
        ASSERT_EQ(test::fault_of_front(built.tree, front, whole), "") << "front " << i;
        ASSERT_EQ(test::turned_triangles(built.tree.data(), front), 0u) << "front " << i;
      }
      for (std::uint32_t level = 0; level < topology.level_count(); ++level)
        ASSERT_EQ(test::fault_of_front(built.tree, test::uniform_front(topology, level), whole), "")
            << "level " << level;
    }
  }
}

}  // namespace
}  // namespace varifold
