// Patches that move, drawn by one call, against the array path and against the processor.
#include <gtest/gtest.h>
#include <tests/models/patch_tree/tree_fronts.h>
#include <tests/models/patch_tree/tree_of.h>
#include <tests/render/mirrored_patches.h>
#include <tests/render/pixel_counts.h>
#include <tests/render/scenes.h>
#include <tests/support/poses.h>
#include <tests/support/rigged_meshes.h>
#include <varifold/mesh/rig_pose.h>
#include <varifold/models/patch_tree/front.h>
#include <varifold/models/patch_tree/instance.h>
#include <varifold/models/patch_tree/patch_draws.h>
#include <varifold/render/image_difference.h>

namespace varifold {
namespace {

using TreePointer = std::shared_ptr<const PatchTree>;

class PatchPosesTest : public test::RenderTest {
 protected:
  [[nodiscard]] Image8 picture(const PatchDrawList& list, const DrawStyle& style,
                               const PatchStyle& patch_style = {}) {
    auto image = renderer().render({list, style, patch_style}, camera, plain_background());
    EXPECT_TRUE(image) << image.error().message;
    return image ? std::move(*image) : Image8{};
  }
  static double difference(const Image8& a, const Image8& b) {
    const auto found = image_difference(a, b, 6);
    return found ? found->part_above : 1;
  }

  // The same front by index arrays in the pose, by one call in the pose, and by index arrays of a
  // mesh that the processor has moved.
  void expect_like_others(const TreePointer& tree, const test::SplitNodes& front,
                          const DrawStyle& style) {
    PatchDraws draws(std::make_shared<const PatchDrawTables>(tree));
    draws.show(front);
    const Image8 drawn = picture(draws.list(), style);
    const TriangleMesh level = extract_front(*tree, front);
    EXPECT_LE(difference(drawn, picture_of(level, style)), 2e-4) << "arrays";
    DrawStyle still = style;
    still.pose = {};
    PosedVertices vertices = blend_poses(level, style.pose.weights);
    if (!style.pose.joints.empty()) skin_vertices(level.skin, style.pose.joints, vertices);
    EXPECT_LE(difference(drawn, picture_of(moved_mesh(level, vertices), still)), 2e-3)
        << "processor";
    EXPECT_GT(difference(drawn, picture(draws.list(), still)), 0.01) << "nothing has moved";
  }
};

TEST_F(PatchPosesTest, BlendsAreThoseOfTheOtherPaths) {
  TriangleMesh mesh = test::with_poses(test::round_sphere(8000), 12, 3, 0.12f);
  mesh.poses[1].normals = mesh.normals;
  Random random(3);
  for (const std::uint32_t per_patch : {40u, 300u}) {
    const TreePointer tree = test::tree_of(mesh, per_patch);
    for (int i = 0; i < 4; ++i) {
      const std::vector<std::vector<float>> blends{
          {0.5f},
          {0, 1},
          {0.2f, 0.3f, 0, 0.25f, 0, -0.1f, 0.1f, 0.1f, 0.05f, 0, 0.1f},
          {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}};
      DrawStyle style;
      style.pose.weights = blends[static_cast<std::size_t>(i)];
      style.wireframe = i == 1;
      style.shading = i == 2 ? Shading::kFlat : Shading::kSmooth;
      expect_like_others(tree, test::random_front(tree->topology(), random), style);
    }
  }
}

TEST_F(PatchPosesTest, JointsAreThoseOfTheOtherPaths) {
  // Random poses would leave no collapse that is legal in all of them; here they bend smoothly.
  TriangleMesh mesh = test::with_random_rig(test::round_sphere(4000), 5, {.poses = 2});
  mesh.poses = test::with_poses(test::round_sphere(4000), 2, 3, 0.12f).poses;
  const TreePointer tree = test::tree_of(mesh, 100);
  ASSERT_GT(tree->topology().level_count(), 2u);
  const RigPose pose = pose_rig(mesh, 0, 0.4f);
  Random random(3);
  const test::SplitNodes front = test::random_front(tree->topology(), random);
  DrawStyle style;
  style.pose = {pose.weights, pose.joints};
  expect_like_others(tree, front, style);
  style.pose = {{}, pose.joints};
  expect_like_others(tree, front, style);
}

TEST_F(PatchPosesTest, MeshesWithoutNormalsHaveFacets) {
  TriangleMesh mesh = test::with_poses(test::round_sphere(4000), 2, 4, 0.12f);
  mesh.normals.clear();
  const TreePointer tree = test::tree_of(mesh, 100);
  DrawStyle style;
  const std::vector<float> weights{0.3f, 0.6f};
  style.pose.weights = weights;
  expect_like_others(tree, test::uniform_front(tree->topology(), 1), style);
}

// Geomorphs go from place to place of the pose, and no border opens in it.
TEST_F(PatchPosesTest, BlendBetweenLevelsInThePose) {
  const TriangleMesh mesh = test::with_poses(test::round_sphere(16000), 2, 6, 0.12f);
  const TreePointer tree = test::tree_of(mesh, 60);
  PatchDraws draws(std::make_shared<const PatchDrawTables>(tree, PatchMeasure::kPixels));
  PatchFront front(tree);
  const std::vector<float> weights{0.5f, 0.3f};
  const PosedVertices posed = blend_poses(tree->data().vertices, weights);
  double moved = 0;
  for (int i = 0; i < 6; ++i) {
    turn_camera(static_cast<float>(60 * i));
    RefineCriteria criteria;
    criteria.view.emplace(camera);
    PatchFrontOptions options;
    options.limits.tolerance = 0.5f + static_cast<float>(i);
    front.adapt(criteria, options);
    draws.follow(front.draws(), true);
    DrawStyle style;
    style.shading = Shading::kFlat;
    style.back_tint = Vec3(1, 0, 0);
    DrawStyle still = style;
    style.pose.weights = weights;
    PatchStyle morphing;
    morphing.morph = pixel_morph_range(criteria.view->scale, options.limits.tolerance);
    const Image8 image = picture(draws.list(), style, morphing);
    EXPECT_EQ(test::enclosed_background_pixels(*renderer().read_depth()), 0);
    PatchDrawList list = draws.list();
    list.positions = posed.positions;
    const Image8 expected = picture_of(test::mirrored_patches(list, morphing.morph), still);
    EXPECT_LE(difference(image, expected), 5e-4);
    EXPECT_LE(test::red_pixels(image), test::red_pixels(expected) + 1);
    moved += difference(image, picture(draws.list(), style));
  }
  EXPECT_GT(moved, 0.01) << "blending shows";
}

TEST_F(PatchPosesTest, WrongPosesAreRefused) {
  const TriangleMesh mesh = test::with_poses(test::round_sphere(1000), 10, 3);
  const TreePointer tree = test::tree_of(mesh, 100);
  PatchDraws draws(std::make_shared<const PatchDrawTables>(tree));
  draws.show(test::uniform_front(tree->topology(), 0));
  const auto draw = [&](const std::vector<float>& weights) {
    DrawStyle style;
    style.pose.weights = weights;
    const auto image = renderer().render({draws.list(), style, {}}, camera);
    return image ? std::string() : image.error().message;
  };
  EXPECT_EQ(draw(std::vector<float>(8, 0.1f)), "");
  EXPECT_EQ(draw(std::vector<float>(9, 0.1f)), "renderer: more than 8 poses with a weight");
  std::vector<float> beyond(12, 0.0f);
  EXPECT_EQ(draw(beyond), "");
  beyond.back() = 1;
  EXPECT_EQ(draw(beyond), "renderer: a weight for pose 12 of 10");
  PatchDrawList bad = draws.list();
  std::vector<Pose> poses(bad.poses.begin(), bad.poses.end());
  poses[3].positions.pop_back();
  bad.poses = poses;
  EXPECT_FALSE(renderer().add(bad));
  bad = draws.list();
  const std::vector<JointWeights> skin(3);
  bad.skin = skin;
  EXPECT_FALSE(renderer().add(bad));
}

}  // namespace
}  // namespace varifold
