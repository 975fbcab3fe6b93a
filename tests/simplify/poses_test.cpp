// Meshes that take several shapes: one sequence for all of them.
#include <gtest/gtest.h>
#include <tests/simplify/sequence_checks.h>
#include <tests/support/meshes.h>
#include <tests/support/poses.h>
#include <tests/support/test_files.h>
#include <varifold/io/pose_files.h>
#include <varifold/measure/closest_point.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/validation.h>
#include <varifold/mesh/weld.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <filesystem>

namespace varifold {
namespace {

using test::NamedMesh;

Simplification simplified(const TriangleMesh& mesh, const SimplifyOptions& options = {}) {
  auto result = simplify(mesh, options);
  EXPECT_TRUE(result) << result.error().message;
  return result ? std::move(*result) : Simplification{};
}

TEST(Poses, LevelsAreSoundInEveryShape) {
  std::uint64_t seed = 1;
  for (const NamedMesh& named : test::all_groups()) {
    SCOPED_TRACE(named.name);
    const TriangleMesh posed = test::with_poses(named.mesh, 3, ++seed);
    const Simplification result = simplified(posed);
    test::expect_consistent(result.detailed);
    test::expect_wedges_move_together(result.detailed);
    for (std::size_t shape = 0; shape < 4; ++shape) {
      SCOPED_TRACE(shape);
      const DetailedMesh alone = test::in_shape(result.detailed, shape);
      for (const std::uint32_t level : test::spread_levels(alone.sequence, 10))
        test::expect_sound_level(alone, level);
    }
  }
}

// At rest, and in another pose, all faces of some part have no area: they say nothing of which side
// is outside, but what is around them does.
TEST(Poses, SquashedPartsDoNotTurnOver) {
  for (const float depth : {0.3f, 0.7f})
    for (const bool is_tilted : {false, true}) {
      TriangleMesh mesh = test::icosphere(5'000);
      mesh.normals.clear();
      const TriangleMesh round = mesh;
      mesh.poses.resize(2);
      for (Pose& pose : mesh.poses) pose.positions = mesh.positions;
      for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3 p = round.positions[v];
        // To a point, or onto a line.
        if (p.z > depth) mesh.positions[v] = Vec3(is_tilted ? p.x : 0.1f, 0.05f, 0.5f * depth);
        if (p.x < -depth) mesh.poses[1].positions[v] = Vec3(-0.4f, 0, is_tilted ? p.z : 0.0f);
      }
      const Simplification result = simplified(mesh);
      const auto& sequence = result.detailed.sequence;
      for (std::size_t shape = 0; shape < 3; ++shape) {
        SCOPED_TRACE(shape);
        const DetailedMesh alone = test::in_shape(result.detailed, shape);
        const TriangleMesh full = mesh_at_level(alone, sequence.step_count());
        for (const std::uint32_t level : test::spread_levels(alone.sequence, 20))
          ASSERT_EQ(count_flipped(mesh_at_level(alone, level), full), 0u) << "level " << level;
      }
    }
}

TEST(Poses, AreCarriedToTheLevels) {
  TriangleMesh mesh = test::with_poses(test::icosphere(300), 2, 5);
  mesh.poses[1].normals = mesh.normals;
  mesh.skin.resize(mesh.vertex_count());
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    mesh.skin[v] = {{static_cast<std::uint16_t>(v % 7), 0, 0, 0}, {1, 0, 0, 0}};
  const DetailedMesh detailed = simplified(mesh).detailed;
  ASSERT_EQ(detailed.mesh.poses.size(), 2u);
  for (std::uint32_t v = 0; v < detailed.mesh.vertex_count(); ++v) {
    const std::uint32_t original = detailed.original_vertex[v];
    for (std::size_t i = 0; i < 2; ++i)
      ASSERT_EQ(detailed.mesh.poses[i].positions[v], mesh.poses[i].positions[original]);
    ASSERT_EQ(detailed.mesh.poses[1].normals[v], mesh.normals[original]);
    ASSERT_EQ(detailed.mesh.skin[v], mesh.skin[original]);
  }
  const TriangleMesh level = mesh_at_level(detailed, detailed.sequence.step_count() / 2);
  EXPECT_EQ(level.poses[0].positions.size(), level.positions.size());
  EXPECT_EQ(level.skin.size(), level.positions.size());
  EXPECT_TRUE(level.poses[0].normals.empty());
}

// Brute force: every vertex of the full mesh in the blend against the level in the blend.
void expect_bound_in_blends(const DetailedMesh& detailed, std::uint64_t seed, double* tightest) {
  const CollapseSequence& sequence = detailed.sequence;
  const double diagonal = bounds(detailed.mesh).diagonal();
  for (std::uint64_t i = 0; i < 12; ++i) {
    const auto weights = test::blend_weights(detailed.shapes().size(), 100 * seed + i);
    const DetailedMesh blended = test::in_blend(detailed, weights);
    for (const std::uint32_t level : test::spread_levels(sequence, 6)) {
      const SurfaceDistance surface(mesh_at_level(blended, level));
      double farthest = 0;
      for (const Vec3& p : blended.mesh.positions)
        farthest = std::max(farthest, surface.distance(p));
      ASSERT_LE(farthest, sequence.error[level] * 1.0001 + 2e-6 * diagonal)
          << "level " << level << ", blend " << i;
      if (farthest > 1e-3 * diagonal)
        *tightest = std::min(*tightest, sequence.error[level] / farthest);
    }
  }
}

TEST(Poses, ErrorsBoundEveryBlend) {
  std::vector<NamedMesh> meshes = test::group_closed();
  const auto seams = test::group_seams();
  meshes.insert(meshes.end(), seams.begin(), seams.end());
  meshes.push_back({"planet", planet({{.triangles = 3000}})});
  meshes.push_back({"terrain", *generate("terrain", {.triangles = 2000})});
  std::uint64_t seed = 7;
  double tightest = 1e9;
  for (const NamedMesh& named : meshes) {
    SCOPED_TRACE(named.name);
    const DetailedMesh detailed = simplified(test::with_poses(named.mesh, 3, ++seed)).detailed;
    EXPECT_TRUE(detailed.sequence.error_is_measured);
    expect_bound_in_blends(detailed, seed, &tightest);
  }
  // A measurement, no rough bound: some level in some blend reaches it closely.
  EXPECT_LT(tightest, 1.3);
}

TEST(Poses, SamplesCountLikePosesButAreNotKept) {
  const TriangleMesh rest = planet({{.triangles = 2000}});
  const TriangleMesh posed = test::with_poses(rest, 3, 11);
  SimplifyOptions options;
  options.poses.samples = posed.poses;
  const DetailedMesh sampled = simplified(rest, options).detailed;
  const DetailedMesh kept = simplified(posed).detailed;
  EXPECT_EQ(sampled.sequence.target, kept.sequence.target);
  EXPECT_EQ(sampled.sequence.error, kept.sequence.error);
  EXPECT_TRUE(sampled.mesh.poses.empty());
  ASSERT_EQ(sampled.samples.size(), 3u);
  EXPECT_EQ(sampled.samples[2].positions, kept.mesh.poses[2].positions);
}

TEST(Poses, WithPosesLikeTheMeshTheOrderIsThatOfTheMesh) {
  const TriangleMesh rest = planet({{.triangles = 2000}});
  TriangleMesh posed = rest;
  for (int i = 0; i < 3; ++i) posed.poses.push_back({"", rest.positions, {}});
  // Four equal terms make the same mean, to the bit.
  EXPECT_EQ(simplified(posed).detailed.sequence.target, simplified(rest).detailed.sequence.target);
}

TEST(Poses, PointsThatAPosePartsAreTwo) {
  // Two squares side by side: as one surface, and opened along the common side by a pose.
  TriangleMesh mesh = test::make_mesh(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}},
      {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7});
  EXPECT_EQ(weld_points(mesh).class_count, 6u);
  mesh.poses.push_back({"same", mesh.positions, {}});
  EXPECT_EQ(weld_points(mesh).class_count, 6u);
  mesh.poses.push_back(mesh.poses[0]);
  for (std::size_t v = 4; v < 8; ++v) mesh.poses[1].positions[v].x += 1;
  EXPECT_EQ(weld_points(mesh).class_count, 8u);
  mesh.poses.clear();
  mesh.skin.resize(8);
  EXPECT_EQ(weld_points(mesh).class_count, 6u);
  mesh.skin[4].joints[3] = 700;
  EXPECT_EQ(weld_points(mesh).class_count, 7u);
  mesh.skin[7].weights[3] = 0.25f;
  EXPECT_EQ(weld_points(mesh).class_count, 8u);
}

TEST(Poses, DoNotDependOnThreads) {
  const TriangleMesh posed = test::with_poses(planet({{.triangles = 60000}}), 2, 3);
  SimplifyOptions options;
  options.threads = 1;
  const DetailedMesh one = simplified(posed, options).detailed;
  options.threads = 3;
  const DetailedMesh three = simplified(posed, options).detailed;
  EXPECT_EQ(one.original_vertex, three.original_vertex);
  EXPECT_EQ(one.sequence.target, three.sequence.target);
  EXPECT_EQ(one.sequence.error, three.sequence.error);
}

TEST(Poses, FaultsAreNamed) {
  const auto message = [](const TriangleMesh& mesh, const SimplifyOptions& options = {}) {
    const auto result = simplify(mesh, options);
    return result ? std::string("no fault") : result.error().message;
  };
  TriangleMesh mesh = test::with_poses(test::cube(), 2, 1);
  mesh.poses[1].positions.pop_back();
  EXPECT_EQ(message(mesh), "pose 2: 7 positions for 8 vertices");
  mesh = test::with_poses(test::cube(), 1, 1);
  mesh.poses[0].positions[3].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(message(mesh), "pose 1: vertex 3 has a position that is not finite");
  mesh = test::with_poses(test::cube(), 1, 1);
  EXPECT_EQ(message(mesh, {.placement = Placement::kOptimal}),
            "vertices of a mesh with poses or a skin must stay where they are (placement kept)");
  EXPECT_EQ(message(mesh, {.metric = Metric::kEnergy}),
            "energy is not defined for several poses (metric quadric)");
  const std::vector<Pose> samples{{"short", {Vec3(0)}, {}}};
  SimplifyOptions options;
  options.poses.samples = samples;
  EXPECT_EQ(message(test::cube(), options), "sample 0 of poses: 1 positions for 8 vertices");
}

// The figures that users are told: one sequence for all poses of a horse at 10 %.
TEST(Poses, OneSequenceServesAllPosesOfAHorse) {
  VARIFOLD_REAL_MESH_OR_SKIP(folder, "horse_poses");
  std::vector<std::filesystem::path> files;
  for (int i = 1; i <= 10; ++i)
    files.push_back(folder /
                    ("horse_" + std::string(i < 10 ? "0" : "") + std::to_string(i) + ".ply"));
  const auto posed = read_pose_files(folder / "horse_ref.ply", files);
  ASSERT_TRUE(posed) << posed.error().message;
  SimplifyOptions options;
  options.measure_error = false;
  const DetailedMesh shared = simplified(posed->mesh, options).detailed;
  options.poses.poses_order = false;
  const DetailedMesh first = simplified(posed->mesh, options).detailed;
  const std::uint32_t budget = posed->mesh.triangle_count() / 10;
  const auto rms = [&](const DetailedMesh& detailed, std::size_t shape) {
    const DetailedMesh alone = test::in_shape(detailed, shape);
    const std::uint32_t level = alone.sequence.level_for_triangles(budget);
    return surface_distance(alone.mesh, mesh_at_level(alone, level)).rms;
  };
  double worst_shared = 0, worst_first = 0;
  for (std::size_t shape = 0; shape <= posed->mesh.poses.size(); ++shape) {
    TriangleMesh alone = posed->mesh;
    alone.poses.clear();
    if (shape > 0) alone.positions = posed->mesh.poses[shape - 1].positions;
    const double own = rms(simplified(alone, options).detailed, 0);
    const double by_shared = rms(shared, shape);
    EXPECT_LE(by_shared, 1.25 * own) << "shape " << shape;
    worst_shared = std::max(worst_shared, by_shared);
    worst_first = std::max(worst_first, rms(first, shape));
  }
  EXPECT_LE(worst_shared, 0.5 * worst_first);
}

}  // namespace
}  // namespace varifold
