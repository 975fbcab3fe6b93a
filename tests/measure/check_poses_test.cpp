// The check of models with poses: nothing where there is nothing, and what was broken in a pose or
// between poses alone.
#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <tests/support/poses.h>
#include <varifold/measure/check_frame_strips.h>
#include <varifold/measure/check_model.h>
#include <varifold/measure/check_patch_tree.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/generators.h>
#include <varifold/models/lodstrips/build.h>
#include <varifold/models/lodstrips/frame_build.h>
#include <varifold/models/patch_tree/build.h>
#include <varifold/models/pm/build.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/models/vdpm/instance.h>
#include <varifold/simplify/simplify.h>
#include <cmath>
#include <set>
#include <string>

namespace varifold {
namespace {

using Kinds = std::set<std::string>;

template <class Check>
Kinds kinds_of(const Check& check) {
  EXPECT_TRUE(check);
  Kinds kinds;
  for (const Fault& fault : check->faults)
    if (fault.severity != Severity::kNote) kinds.insert(fault.kind);
  return kinds;
}

ModelCheckOptions few_levels() {
  ModelCheckOptions options;
  options.all_levels_up_to = 40;
  options.spread_levels = 12;
  return options;
}

Kinds faults_of(ViewDependentMeshData data) {
  return kinds_of(check_model<ViewDependentInstance>(
      std::make_shared<const ViewDependentMesh>(std::move(data)), few_levels()));
}
Kinds faults_of(PatchTreeData data) {
  return kinds_of(
      check_patch_tree(std::make_shared<const PatchTree>(std::move(data)), few_levels()));
}
Kinds faults_of_levels(const DetailedMesh& detailed) {
  return kinds_of(check_progressive_mesh(
      std::make_shared<const ProgressiveMesh>(build_progressive_mesh(detailed)), few_levels()));
}

PatchTreeData tree_of(const TriangleMesh& mesh) {
  PatchTreeOptions options;
  options.triangles_per_patch = 16;
  return build_patch_tree(mesh, options)->tree.data();
}

// A flat square in shapes that are turned: nothing is off in any of them, but between them.
DetailedMesh turned_square() {
  return simplify(test::with_turned_poses(test::grid(16, 16), 2, 3, 1.5f))->detailed;
}

// A flat strip that the pose bends into a ring within its plane, by a sequence that heeds the shape
// at rest alone: what is left of the strip turns over in the pose.
TriangleMesh ring() {
  TriangleMesh mesh = test::grid(40, 6);
  Pose ring;
  for (const Vec3& p : mesh.positions) {
    const float angle = 5.5f * p.x / 40, radius = 2 + p.y;
    ring.positions.emplace_back(radius * std::sin(angle), radius * std::cos(angle), 0.0f);
  }
  mesh.poses.push_back(ring);
  return mesh;
}
DetailedMesh ring_by_rest() {
  SimplifyOptions options;
  options.poses.poses_order = false;
  return simplify(ring(), options)->detailed;
}

TEST(CheckPoses, AllGroupsAreSound) {
  std::uint64_t seed = 0;
  for (const auto& [name, mesh] : test::all_groups()) {
    SCOPED_TRACE(name);
    ++seed;
    for (const TriangleMesh& posed :
         {test::with_poses(mesh, 2, seed, 0.1f), test::with_turned_poses(mesh, 2, seed, 0.9f)}) {
      const DetailedMesh detailed = simplify(posed)->detailed;
      EXPECT_EQ(faults_of_levels(detailed), Kinds());
      EXPECT_EQ(faults_of(build_view_dependent_mesh(detailed).data()), Kinds());
      EXPECT_EQ(faults_of(tree_of(posed)), Kinds());
      const auto frames = build_frame_strips(posed, {});
      ASSERT_TRUE(frames);
      EXPECT_EQ(kinds_of(check_frame_strips(std::make_shared<const FrameStrips>(frames->model),
                                            few_levels())),
                Kinds());
    }
  }
}

TEST(CheckPoses, FindsTrianglesThatAreTurnedInOnePose) {
  const DetailedMesh detailed = ring_by_rest();
  EXPECT_EQ(faults_of_levels(detailed), Kinds{"pose_flipped_triangle"});
  EXPECT_EQ(faults_of(build_view_dependent_mesh(detailed).data()),
            (Kinds{"pose_flipped_triangle", "pose_front_flipped_triangle"}));
}

// The errors of levels are those of the shapes alone: only blends are farther away.
TEST(CheckPoses, FindsErrorsThatAreTooSmallBetweenPoses) {
  DetailedMesh detailed = turned_square();
  EXPECT_EQ(faults_of_levels(detailed), Kinds());
  const float diagonal = bounds(detailed.mesh).diagonal();
  CollapseSequence& sequence = detailed.sequence;
  float error = 0;
  for (std::uint32_t level = sequence.step_count(); level-- > 0;) {
    for (std::size_t shape = 0; shape < 3; ++shape) {
      const DetailedMesh alone = test::in_shape(detailed, shape);
      const SurfaceDistance surface(mesh_at_level(alone, level));
      for (const Vec3& p : alone.mesh.positions)
        error = std::max(error, static_cast<float>(surface.distance(p)) + 1e-6f * diagonal);
    }
    sequence.error[level] = error;
  }
  EXPECT_EQ(faults_of_levels(detailed), Kinds{"pose_error_exceeded"});
}

TEST(CheckPoses, FindsFrontsWithErrorsThatAreTooSmall) {
  ViewDependentMeshData data = build_view_dependent_mesh(turned_square()).data();
  EXPECT_EQ(faults_of(data), Kinds());
  for (PackedBounds& bounds : data.bounds) bounds.mu = bounds.delta = 0;
  EXPECT_EQ(faults_of(data), Kinds{"pose_front_error_exceeded"});
}

TEST(CheckPoses, FindsPatchesThatAreWrongInOnePoseOrBetweenThem) {
  const PatchTreeData sound = tree_of(test::with_poses(planet({{.triangles = 3000}}), 2, 5, 0.1f));
  EXPECT_EQ(faults_of(sound), Kinds());
  PatchTreeData data = sound;
  std::vector<Vec3>& places = data.vertices.poses[1].positions;
  places[places.size() - 1] *= 3.0f;
  EXPECT_TRUE(faults_of(data).count("pose_outside_ball"));
  data = sound;
  for (PatchBounds& bounds : data.bounds) bounds.error *= 0.2f;
  EXPECT_TRUE(faults_of(data).count("pose_error_exceeded"));
  // The corners of the finest triangles change sides in the second pose.
  data = sound;
  for (Vec3& p : data.vertices.poses[1].positions) p.x = -p.x;
  EXPECT_FALSE(faults_of(data).empty());
}

// Borders that are switched as the shape at rest allows.
TEST(CheckPoses, FindsPatchesThatTurnInOnePose) {
  const TriangleMesh mesh = test::with_poses(planet({{.triangles = 3000}}), 2, 7, 0.3f);
  PatchTreeOptions options;
  options.triangles_per_patch = 16;
  options.poses.poses_order = false;
  const Kinds faults = faults_of(build_patch_tree(mesh, options)->tree.data());
  EXPECT_TRUE(faults.count("pose_turned_triangle"));
  EXPECT_FALSE(faults_of(tree_of(mesh)).count("pose_turned_triangle"));
  for (const std::string& kind : faults) EXPECT_TRUE(kind.starts_with("pose_")) << kind;
}

TEST(CheckPoses, FindsAFrameOfAnotherShape) {
  const TriangleMesh mesh = test::with_poses(test::icosphere(320), 2, 5, 0.1f);
  auto frames = build_frame_strips(mesh, {});
  ASSERT_TRUE(frames);
  FrameStripsData data = frames->model.data();
  data.frames[2].weights = data.frames[1].weights;  // with the errors of its own
  for (float& weight : data.frames[2].weights) weight *= 4;
  const auto check =
      check_frame_strips(std::make_shared<const FrameStrips>(std::move(data)), few_levels());
  ASSERT_TRUE(check);
  ASSERT_FALSE(check->faults.empty());
  for (const Fault& fault : check->faults) EXPECT_TRUE(fault.where.starts_with("frame 2"));
}

}  // namespace
}  // namespace varifold
