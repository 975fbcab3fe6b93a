// Poses and joints in the vertex shader against the same on the processor.
#include <gtest/gtest.h>
#include <tests/render/scenes.h>
#include <tests/support/poses.h>
#include <tests/support/rigged_meshes.h>
#include <varifold/mesh/pose_blend.h>
#include <varifold/mesh/rig_pose.h>
#include <varifold/render/image_difference.h>
#include <varifold/render/mesh_draw_list.h>
#include <vector>

namespace varifold {
namespace {

using test::RenderTest;

class PosedRendererTest : public RenderTest {
 protected:
  // The mesh moved on the processor.
  [[nodiscard]] Image8 moved_picture(TriangleMesh mesh, const DrawPose& pose) {
    PosedVertices vertices = blend_poses(mesh, pose.weights);
    if (!pose.joints.empty()) skin_vertices(mesh.skin, pose.joints, vertices);
    mesh.positions = std::move(vertices.positions);
    mesh.normals = std::move(vertices.normals);
    mesh.poses.clear();
    mesh.skin.clear();
    return picture_of(mesh);
  }
  void expect_like_processor(const TriangleMesh& mesh, const DrawPose& pose) {
    DrawStyle style;
    style.pose = pose;
    const Image8 drawn = picture_of(mesh, style);
    const auto difference = image_difference(drawn, moved_picture(mesh, pose), 3);
    ASSERT_TRUE(difference);
    // Along edges of triangles a rounding of places may decide.
    EXPECT_LT(difference->part_above, 0.002);
    const auto at_rest = image_difference(drawn, picture_of(mesh), 3);
    EXPECT_GT(at_rest->part_above, 0.01) << "nothing has moved";
  }
};

TEST_F(PosedRendererTest, BlendsOfPosesAreThoseOfTheProcessor) {
  TriangleMesh mesh = test::with_poses(test::round_sphere(2000), 12, 3, 0.15f);
  mesh.poses[1].normals = mesh.normals;
  for (const std::vector<float>& weights : std::vector<std::vector<float>>{
           {0.5f}, {0, 1}, {0.2f, 0.3f, 0, 0.25f, 0, -0.1f, 0.1f, 0.1f, 0.05f, 0, 0.1f}}) {
    expect_like_processor(mesh, {weights, {}});
  }
}

TEST_F(PosedRendererTest, JointsAreThoseOfTheProcessor) {
  const TriangleMesh mesh = test::with_random_rig(test::round_sphere(2000), 5);
  const RigPose pose = pose_rig(mesh, 0, 0.4f);
  expect_like_processor(mesh, {pose.weights, pose.joints});
  expect_like_processor(mesh, {{}, pose.joints});
}

TEST_F(PosedRendererTest, UpdatesReachThePoses) {
  TriangleMesh mesh = test::with_poses(test::round_sphere(500), 2, 3, 0.15f);
  DrawStyle style;
  const std::vector<float> weights{0, 1};
  style.pose.weights = weights;
  MeshDrawList drawn(mesh);
  const auto name = renderer().add(drawn.list());
  ASSERT_TRUE(name);
  for (Vec3& p : mesh.poses[1].positions) p = 0.5f * p;
  DrawList list = drawn.list();
  const ElementRange all{0, mesh.vertex_count()};
  list.changed_vertices = {&all, 1};
  ASSERT_TRUE(renderer().update(*name, list));
  ASSERT_TRUE(renderer().begin(camera, plain_background()));
  ASSERT_TRUE(renderer().draw(*name, list, style));
  const auto image = renderer().read_image();
  ASSERT_TRUE(image);
  EXPECT_LT(image_difference(*image, moved_picture(mesh, style.pose), 3)->part_above, 0.002);
}

TEST_F(PosedRendererTest, WrongPosesAreRefused) {
  const TriangleMesh mesh = test::with_poses(test::round_sphere(200), 10, 3);
  const MeshDrawList drawn(mesh);
  const auto draw = [&](const std::vector<float>& weights) {
    DrawStyle style;
    style.pose.weights = weights;
    const auto image = renderer().render(drawn.list(), camera, style);
    return image ? std::string() : image.error().message;
  };
  EXPECT_EQ(draw(std::vector<float>(8, 0.1f)), "");
  EXPECT_EQ(draw(std::vector<float>(9, 0.1f)), "renderer: more than 8 poses with a weight");
  std::vector<float> beyond(12, 0.0f);
  EXPECT_EQ(draw(beyond), "");
  beyond.back() = 1;
  EXPECT_EQ(draw(beyond), "renderer: a weight for pose 12 of 10");
  TriangleMesh broken = mesh;
  broken.poses[3].positions.pop_back();
  EXPECT_FALSE(renderer().add(MeshDrawList(broken).list()));
}

}  // namespace
}  // namespace varifold
