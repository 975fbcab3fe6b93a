#include <varifold/simplify/collapse_sequence.h>

#include <gtest/gtest.h>
#include <tests/simplify/sequence_checks.h>
#include <tests/support/meshes.h>
#include <varifold/base/random.h>
#include <varifold/mesh/generators.h>
#include <varifold/simplify/sequence_replay.h>

namespace varifold {
namespace {

TEST(CollapseSequence, AncestorAgreesWithAncestors) {
  const auto result = simplify(planet({{.triangles = 1000}}));
  const CollapseSequence& sequence = result->detailed.sequence;
  for (const std::uint32_t level : test::spread_levels(sequence, 10)) {
    const auto ancestors = sequence.ancestors(level);
    for (std::uint32_t v = 0; v < ancestors.size(); ++v) {
      ASSERT_EQ(ancestors[v], sequence.ancestor(v, level));
      ASSERT_LT(ancestors[v], sequence.vertices[level]);
    }
  }
}

TEST(CollapseSequence, FindsLevelsByCount) {
  CollapseSequence sequence;
  sequence.vertices = {4, 5, 6, 8};
  sequence.triangles = {4, 6, 8, 12};
  sequence.error = {3, 2, 2, 0};
  EXPECT_EQ(sequence.level_for_triangles(3), 0u);
  EXPECT_EQ(sequence.level_for_triangles(4), 0u);
  EXPECT_EQ(sequence.level_for_triangles(7), 1u);
  EXPECT_EQ(sequence.level_for_triangles(12), 3u);
  EXPECT_EQ(sequence.level_for_triangles(100), 3u);
  EXPECT_EQ(sequence.level_for_vertices(7), 2u);
  EXPECT_EQ(sequence.level_for_error(3), 0u);
  EXPECT_EQ(sequence.level_for_error(2.5f), 1u);
  EXPECT_EQ(sequence.level_for_error(1), 3u);
}

TEST(SequenceReplay, WalksThroughTheLevels) {
  for (const test::NamedMesh& named : test::all_groups()) {
    SCOPED_TRACE(named.name);
    const auto result = simplify(named.mesh);
    ASSERT_TRUE(result);
    const DetailedMesh& detailed = result->detailed;
    SequenceReplay replay(detailed);
    while (replay.level() > 0) {
      const std::uint32_t before = replay.level();
      replay.collapse();
      ASSERT_EQ(replay.level(), before - 1);
      ASSERT_EQ(replay.removed().size(),
                detailed.sequence.triangles[before] - detailed.sequence.triangles[before - 1]);
      if (replay.level() % 7 != 0) continue;
      const auto ancestors = detailed.sequence.ancestors(replay.level());
      for (std::uint32_t t = 0; t < detailed.mesh.triangle_count(); ++t) {
        if (detailed.sequence.triangle_level[t] > replay.level()) continue;
        for (std::uint32_t k = 0; k < 3; ++k)
          ASSERT_EQ(replay.corners()[3 * t + k], ancestors[detailed.mesh.indices[3 * t + k]]);
      }
    }
  }
}

TEST(CollapseSequence, PlacementFollowsTheLevels) {
  SimplifyOptions options;
  options.placement = Placement::kOptimal;
  const auto result = simplify(planet({{.triangles = 500}}), options);
  const DetailedMesh& detailed = result->detailed;
  ASSERT_TRUE(detailed.sequence.moves_vertices());
  EXPECT_EQ(mesh_at_level(detailed, detailed.sequence.step_count()).positions,
            detailed.mesh.positions);
  // One step below the full level exactly the placed vertices differ.
  const std::uint32_t level = detailed.sequence.step_count() - 1;
  const TriangleMesh mesh = mesh_at_level(detailed, level);
  std::uint32_t moved = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    moved += mesh.positions[v] != detailed.mesh.positions[v];
  EXPECT_EQ(moved, 1u);
}

}  // namespace
}  // namespace varifold
