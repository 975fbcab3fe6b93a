// LodStrips with a sequence for every frame or for groups of frames.
#include <gtest/gtest.h>
#include <tests/simplify/sequence_checks.h>
#include <tests/support/count_allocations.h>
#include <tests/support/meshes.h>
#include <tests/support/poses.h>
#include <tests/support/test_files.h>
#include <varifold/base/random.h>
#include <varifold/io/pose_files.h>
#include <varifold/measure/check_frame_strips.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/pose_blend.h>
#include <varifold/models/lodstrips/frame_build.h>
#include <varifold/models/lodstrips/frame_clusters.h>
#include <algorithm>
#include <array>
#include <set>

namespace varifold {
namespace {

std::shared_ptr<const FrameStrips> build(const TriangleMesh& mesh, std::uint32_t sequences,
                                         std::vector<std::vector<float>> frames = {}) {
  FrameStripsOptions options;
  options.sequences = sequences;
  options.frames = std::move(frames);
  auto built = build_frame_strips(mesh, options);
  EXPECT_TRUE(built) << built.error().message;
  return built ? std::make_shared<const FrameStrips>(std::move(built->model)) : nullptr;
}

std::vector<test::NamedMesh> posed_meshes() {
  std::vector<test::NamedMesh> meshes = test::all_groups();
  std::uint64_t seed = 0;
  for (test::NamedMesh& named : meshes)
    named.mesh = test::with_poses(std::move(named.mesh), 3, ++seed, 0.1f);
  return meshes;
}

TEST(FrameStrips, EveryFrameOfEveryGroupIsSound) {
  for (const auto& [name, mesh] : posed_meshes()) {
    if (mesh.triangle_count() > 3000) continue;
    for (const std::uint32_t sequences : {0u, 1u, 2u}) {
      SCOPED_TRACE(name + " " + std::to_string(sequences));
      const auto model = build(mesh, sequences);
      // Frames of no loss share one even where there could be more.
      EXPECT_LE(model->data().sequences.size(), sequences == 0 ? 4u : sequences);
      EXPECT_GE(model->data().sequences.size(), sequences == 0 ? 4u : 1u);
      if (model->attributes().vertex_count() == 0) continue;
      ModelCheckOptions options;
      options.all_levels_up_to = 60;
      options.spread_levels = 16;
      const auto check = check_frame_strips(model, options);
      ASSERT_TRUE(check);
      for (const Fault& fault : check->faults)
        EXPECT_EQ(fault.severity, Severity::kNote) << fault.kind << ": " << fault.where;
    }
  }
}

// Every way through frames and levels ends in the same bytes as a fresh instance.
TEST(FrameStrips, ListsDependOnFrameAndLevelAlone) {
  const auto model = build(test::with_poses(planet({{.triangles = 2000}}), 4, 3), 3);
  FrameStripsInstance walker(model);
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const std::uint32_t frame = random.below(model->frame_count());
    const std::uint32_t level = random.below(model->finest_level() + 1);
    walker.go_to_frame(frame);
    walker.go_to_level(level);
    FrameStripsInstance fresh(model);
    fresh.go_to_level(level);
    fresh.go_to_frame(frame);
    const DrawList a = walker.draw_list(), b = fresh.draw_list();
    ASSERT_TRUE(std::equal(a.indices.begin(), a.indices.end(), b.indices.begin(), b.indices.end()));
    ASSERT_EQ(a.ranges.size(), b.ranges.size());
    EXPECT_EQ(walker.extract().triangle_count(), walker.triangle_count());
    EXPECT_TRUE(walker.draw_list().changed_indices.empty());  // nothing has changed since
  }
}

TEST(FrameStrips, GoingAnywhereAllocatesNothing) {
  const auto model = build(test::with_poses(planet({{.triangles = 2000}}), 2, 3), 0);
  FrameStripsInstance instance(model);
  const auto tour = [&] {
    for (std::uint32_t i = 0; i < 40; ++i) {
      instance.go_to_frame(i % model->frame_count());
      instance.go_to_level(model->finest_level() * (i % 7) / 6);
      static_cast<void>(instance.draw_list());
    }
  };
  const std::size_t before = allocations;
  tour();
  EXPECT_EQ(allocations, before);
}

TEST(FrameStrips, CountsHoldInEveryFrame) {
  const auto model = build(test::with_poses(test::grid(30, 20), 3, 8), 0);
  for (const std::uint32_t budget : {5u, 50u, 333u, 900u}) {
    const std::uint32_t level = model->level_for_triangles(budget);
    EXPECT_LE(model->triangle_count(level), budget);
    for (std::uint32_t frame = 0; frame < model->frame_count(); ++frame) {
      FrameStripsInstance instance(model);
      instance.go_to_frame(frame);
      instance.go_to_level(level);
      EXPECT_LE(instance.extract().triangle_count(), budget);
      EXPECT_LE(instance.vertex_count(), model->vertex_count(level));
    }
  }
}

TEST(FrameStrips, SurviveTheFile) {
  for (const auto& [name, mesh] : posed_meshes()) {
    SCOPED_TRACE(name);
    const auto model = build(mesh, 2);
    const auto bytes = encode_frame_strips(*model);
    const auto again = decode_frame_strips(bytes);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(encode_frame_strips(*again), bytes);
    EXPECT_EQ(again->attributes().poses, model->attributes().poses);
    for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 97)
      EXPECT_FALSE(decode_frame_strips({bytes.data(), size})) << size;
  }
}

TEST(FrameStrips, DamagedBytesAreRefusedOrDrawable) {
  const auto model = build(test::with_poses(test::icosphere(80), 2, 1), 0);
  const auto bytes = encode_frame_strips(*model);
  Random random(1);
  for (int i = 0; i < 4000; ++i) {
    auto damaged = bytes;
    for (int k = 0; k < 2; ++k)
      damaged[random.below(static_cast<std::uint32_t>(damaged.size()))] =
          static_cast<std::byte>(random.below(256));
    auto decoded = decode_frame_strips(damaged);
    if (!decoded) continue;
    const auto shared = std::make_shared<const FrameStrips>(std::move(*decoded));
    FrameStripsInstance instance(shared);
    for (const std::uint32_t level : {0u, shared->finest_level() / 2, shared->finest_level()}) {
      instance.go_to_frame(shared->frame_count() - 1);
      instance.go_to_level(level);
      for (const std::uint32_t v : instance.draw_list().indices)
        ASSERT_TRUE(v == kStripRestart || v < shared->attributes().vertex_count());
    }
  }
}

TEST(FrameStrips, FramesAreFoundByTheirWeights) {
  const auto model = build(test::with_poses(test::icosphere(80), 1, 1), 0, morph_frames(5));
  ASSERT_EQ(model->frame_count(), 5u);
  for (const auto& [t, frame] : std::vector<std::pair<float, std::uint32_t>>{
           {-1.0f, 0}, {0.0f, 0}, {0.12f, 0}, {0.13f, 1}, {0.5f, 2}, {0.9f, 4}, {3.0f, 4}})
    EXPECT_EQ(model->frame_for(std::array{t}), frame) << t;
  EXPECT_EQ(model->frame_for({}), 0u);
}

// Two kinds of shapes: frames of a kind must be in one group.
TEST(FrameStrips, GroupsFollowWhatSequencesCost) {
  constexpr std::uint32_t kFrames = 7;
  std::vector<double> loss(kFrames * kFrames);
  for (std::uint32_t i = 0; i < kFrames; ++i)
    for (std::uint32_t j = 0; j < kFrames; ++j)
      loss[i * kFrames + j] = i == j ? 1 : (i < 3) == (j < 3) ? 1.1 + 0.01 * i : 5;
  const auto groups = group_frames(loss, kFrames, 2);
  EXPECT_EQ(groups, (std::vector<std::uint32_t>{0, 0, 0, 1, 1, 1, 1}));
  const auto own = group_frames(loss, kFrames, kFrames);
  EXPECT_EQ(std::set<std::uint32_t>(own.begin(), own.end()).size(), kFrames);
}

// What the three sorts of sequences are for: the more of them, the nearer to that of the frame.
TEST(FrameStrips, OwnSequencesAreAsGoodAsThoseOfTheFrameAlone) {
  VARIFOLD_REAL_MESH_OR_SKIP(folder, "horse_poses");
  std::vector<std::filesystem::path> files;
  for (int i = 1; i <= 5; ++i) files.push_back(folder / ("horse_0" + std::to_string(i) + ".ply"));
  const auto posed = read_pose_files(folder / "horse_ref.ply", files);
  ASSERT_TRUE(posed);
  const TriangleMesh& mesh = posed->mesh;
  const auto worst = [&](std::uint32_t sequences) {
    const auto model = build(mesh, sequences);
    const std::uint32_t level = model->level_for_triangles(mesh.triangle_count() / 10);
    double greatest = 0;
    for (std::uint32_t frame = 0; frame < model->frame_count(); ++frame) {
      TriangleMesh alone = mesh;
      alone.poses.clear();
      if (frame > 0) alone.positions = mesh.poses[frame - 1].positions;
      const auto own = simplify(alone, {.measure_error = false});
      const std::uint32_t own_level =
          own->detailed.sequence.level_for_triangles(mesh.triangle_count() / 10);
      FrameStripsInstance instance(model);
      instance.go_to_frame(frame);
      instance.go_to_level(level);
      TriangleMesh shown = instance.extract();
      shown.positions = blend_poses(shown, model->data().frames[frame].weights).positions;
      shown.poses.clear();
      greatest = std::max(
          greatest,
          surface_distance(alone, shown, {.samples = 30000}).rms /
              surface_distance(alone, mesh_at_level(own->detailed, own_level), {.samples = 30000})
                  .rms);
    }
    return greatest;
  };
  EXPECT_NEAR(worst(0), 1, 0.02);
  EXPECT_LT(worst(1), 1.25);
  EXPECT_LT(worst(3), worst(1));
}

}  // namespace
}  // namespace varifold
