// What the tool does with meshes that take several shapes.
#include <gtest/gtest.h>
#include <tests/cli/models_of_a_kind.h>
#include <tests/cli/run_tool.h>
#include <tests/support/meshes.h>
#include <tests/support/poses.h>
#include <tests/support/rigged_meshes.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/pose_blend.h>
#include <varifold/mesh/rig_pose.h>
#include <varifold/render/image_difference.h>
#include <varifold/render/png.h>
#include <algorithm>
#include <span>

namespace varifold {
namespace {

using nlohmann::json;
using test::lines_of;
using test::run_tool;
using test::ToolResult;

class Posed : public test::ModelsOfAKind {
 protected:
  // The mesh at rest and two poses as files, and the model of all three.
  json make_posed() {
    mesh_ = test::with_poses(planet({{.triangles = 2000}}), 2, 7, 0.1f);
    mesh_.normals.clear();
    std::vector<std::string> arguments{"build", kind(), "--poses"};
    for (int i = 0; i < 3; ++i) {
      TriangleMesh alone = mesh_;
      alone.poses.clear();
      if (i > 0) alone.positions = mesh_.poses[static_cast<std::size_t>(i) - 1].positions;
      const std::string name = path("shape_" + std::to_string(i) + ".ply");
      EXPECT_TRUE(write_mesh(alone, name));
      arguments.push_back(name);
    }
    arguments.insert(arguments.end(), {"-o", path("m.vfm"), "--json"});
    if (kind() == "patchtree") arguments.insert(arguments.end(), {"--patch-triangles", "32"});
    const ToolResult result = run_tool(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.json();
  }
  TriangleMesh extracted(const std::vector<std::string>& options) const {
    std::vector<std::string> arguments{"extract", path("m.vfm"), "--lod",
                                       "1",       "-o",          path("level.glb")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ToolResult result = run_tool(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    auto read = read_mesh(path("level.glb"));
    return read ? std::move(read->mesh) : TriangleMesh();
  }
  static std::vector<Vec3> sorted(std::vector<Vec3> positions) {
    std::sort(positions.begin(), positions.end(), [](const Vec3& a, const Vec3& b) {
      return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    });
    return positions;
  }
  TriangleMesh mesh_;
};

TEST_P(Posed, LevelsComeInAnyPose) {
  EXPECT_EQ(make_posed()["poses"], 2);
  EXPECT_EQ(run_tool({"check", path("m.vfm"), "--json"}).json()["sound"], true);
  const TriangleMesh kept = extracted({});
  EXPECT_EQ(kept.poses.size(), 2u);
  for (const char* pose : {"0", "1", "2"}) {
    const TriangleMesh frozen = extracted({"--pose", pose});
    EXPECT_TRUE(frozen.poses.empty());
    const std::vector<Vec3>& expected =
        pose[0] == '0' ? mesh_.positions
                       : mesh_.poses[static_cast<std::size_t>(pose[0] - '1')].positions;
    EXPECT_EQ(sorted(frozen.positions), sorted(expected)) << pose;
  }
  const TriangleMesh between = extracted({"--blend", "0.25,0.5"});
  const std::vector<float> weights{0.25f, 0.5f};
  EXPECT_EQ(sorted(between.positions), sorted(blend_poses(mesh_, weights).positions));
}

TEST_P(Posed, WrongPosesAreWrongUsage) {
  (void)make_posed();
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{"--pose", "3"},
                                             {"--blend", "0,0,1"},
                                             {"--blend", "nan"},
                                             {"--time", "1"},
                                             {"--animation", "walk"},
                                             {"--pose", "1", "--blend", "1"}}) {
    std::vector<std::string> arguments{"extract", path("m.vfm"), "--lod",
                                       "1",       "-o",          path("level.glb")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ToolResult result = run_tool(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
  }
  EXPECT_FALSE(std::filesystem::exists(path("level.glb")));
}

TEST_P(Posed, TheMorphTestTellsSharesOfFrames) {
  (void)make_posed();
  const ToolResult result = run_tool(
      {"bench", path("m.vfm"), "--test", "morph", "--steps", "9", "--draw", "none", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json bench = result.json()["results"][0];
  EXPECT_EQ(bench["frames"], 9);
  ASSERT_EQ(bench["constant_levels"].size(), 10u);
  EXPECT_EQ(bench["constant_levels"][0]["triangles"], 2000);
  EXPECT_LT(bench["constant_levels"][9]["triangles"], 500);
  EXPECT_EQ(bench["constant_levels"][3]["frames_ms"].size(), 9u);
  EXPECT_EQ(bench["level_every_24_frames"]["frames"], 240);
  EXPECT_EQ(bench["level_every_24_frames"]["levels"].size(), 10u);
  EXPECT_GT(bench["seconds_extraction"], 0);
  (void)make_model("torus", "60");
  const ToolResult still = run_tool({"bench", path("m.vfm"), "--test", "morph"});
  EXPECT_EQ(still.exit_code, 2);
  EXPECT_NE(still.err.find("poses"), std::string::npos) << still.err;
}

INSTANTIATE_TEST_SUITE_P(Kinds, Posed, ::testing::ValuesIn(test::all_kinds()),
                         [](const auto& kind) { return std::string(kind.param); });

class PoseFiles : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  test::TemporaryFolder folder_;
};

TEST_F(PoseFiles, OtherConnectivityIsNamedWithTheFirstDifference) {
  ASSERT_TRUE(write_mesh(test::icosphere(80), path("a.ply")));
  TriangleMesh other = test::icosphere(80);
  std::swap(other.indices[3 * 7], other.indices[3 * 7 + 1]);
  ASSERT_TRUE(write_mesh(other, path("b.ply")));
  const ToolResult result =
      run_tool({"build", "pm", path("a.ply"), "--poses", path("b.ply"), "-o", path("m.vfm")});
  EXPECT_EQ(result.exit_code, 3);
  ASSERT_EQ(lines_of(result.err).size(), 1u) << result.err;
  EXPECT_NE(result.err.find("b.ply: triangle 7 is"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(path("m.vfm")));
}

TEST_F(PoseFiles, AnimationsAreSampledAndKept) {
  const TriangleMesh rigged = test::with_random_rig(test::icosphere(320), 3);
  ASSERT_TRUE(write_mesh(rigged, path("a.glb")));
  const ToolResult built = run_tool(
      {"build", "lodstrips", path("a.glb"), "--pose-samples", "4", "-o", path("m.vfm"), "--json"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  EXPECT_EQ(built.json()["sampled_poses"], 8);  // of two animations
  ASSERT_EQ(run_tool({"extract", path("m.vfm"), "--lod", "0.5", "-o", path("half.glb")}).exit_code,
            0);
  const auto half = read_mesh(path("half.glb"));
  ASSERT_TRUE(half);
  EXPECT_EQ(half->mesh.rig->animations.size(), 2u);
  EXPECT_EQ(half->mesh.poses.size(), 3u);
  EXPECT_TRUE(half->mesh.has_skin());
  ASSERT_EQ(run_tool({"extract", path("m.vfm"), "--lod", "1", "--animation", "1", "--time", "0.3",
                      "-o", path("frozen.glb")})
                .exit_code,
            0);
  const auto frozen = read_mesh(path("frozen.glb"));
  ASSERT_TRUE(frozen);
  EXPECT_FALSE(frozen->mesh.has_skin());
}

TEST_F(PoseFiles, PicturesOfPosesAndSheets) {
  ASSERT_TRUE(write_mesh(test::with_poses(test::icosphere(320), 2, 1), path("a.glb")));
  ASSERT_EQ(run_tool({"build", "vdpm", path("a.glb"), "-o", path("m.vfm")}).exit_code, 0);
  const auto render = [&](std::vector<std::string> options) {
    options.insert(options.begin(),
                   {"render", path("m.vfm"), "-o", path("p.png"), "--size", "64x48", "--json"});
    return run_tool(options);
  };
  const ToolResult posed = render({"--lod", "1", "--pose", "1"});
  if (posed.exit_code != 0 && posed.err.find("OpenGL") != std::string::npos)
    GTEST_SKIP() << "no OpenGL here: " << posed.err;
  ASSERT_EQ(posed.exit_code, 0) << posed.err;
  const std::string first = test::bytes_of(path("p.png"));
  ASSERT_EQ(render({"--lod", "1"}).exit_code, 0);
  EXPECT_NE(test::bytes_of(path("p.png")), first);
  const ToolResult sheet = render({"--sheet", "1,0.5,0.1", "--columns", "4"});
  ASSERT_EQ(sheet.exit_code, 0) << sheet.err;
  EXPECT_EQ(sheet.json()["width"], 4 * 64);
  EXPECT_EQ(sheet.json()["height"], 3 * 48);
  EXPECT_EQ(sheet.json()["row_triangles"][0], 320);
  EXPECT_EQ(render({"--sheet", "1", "--lod", "1"}).exit_code, 2);
  EXPECT_EQ(render({"--lod", "1", "--columns", "4"}).exit_code, 2);
}

// A patch tree by one call, by index arrays, and with geomorphs: in the pose all show the same.
TEST_F(PoseFiles, PicturesOfPatchesInPoses) {
  ASSERT_TRUE(write_mesh(test::with_poses(test::icosphere(5000), 2, 1, 0.1f), path("a.glb")));
  ASSERT_EQ(run_tool({"build", "patchtree", path("a.glb"), "--patch-triangles", "64", "-o",
                      path("m.vfm")})
                .exit_code,
            0);
  const auto picture = [&](std::vector<std::string> options) {
    const std::string file = path("p.png");
    options.insert(options.begin(), {"render", path("m.vfm"), "-o", file, "--size", "160x120",
                                     "--pixels", "2", "--supersampling", "1"});
    const ToolResult result = run_tool(options);
    if (result.exit_code != 0) return Result<Image8>(fail(ErrorKind::kFailed, result.err));
    const std::string bytes = test::bytes_of(file);
    return read_png(std::as_bytes(std::span(bytes)));
  };
  const auto at_rest = picture({});
  if (!at_rest && at_rest.error().message.find("OpenGL") != std::string::npos)
    GTEST_SKIP() << "no OpenGL here: " << at_rest.error().message;
  const auto by_call = picture({"--blend", "0.3,0.6"});
  const auto by_arrays = picture({"--blend", "0.3,0.6", "--arrays"});
  const auto with_morphs = picture({"--blend", "0.3,0.6", "--morph", "--morph-band", "1.5"});
  ASSERT_TRUE(at_rest && by_call && by_arrays && with_morphs);
  EXPECT_LE(image_difference(*by_call, *by_arrays, 6)->part_above, 5e-4);
  EXPECT_GT(image_difference(*by_call, *at_rest, 6)->part_above, 0.02);
  EXPECT_LE(image_difference(*by_call, *with_morphs, 40)->part_above, 0.02);
  EXPECT_NE(*by_call, *with_morphs);
}

TEST_F(PoseFiles, MovedVerticesHaveNoPoses) {
  ASSERT_TRUE(write_mesh(test::with_poses(test::icosphere(80), 1, 1), path("a.glb")));
  const ToolResult result =
      run_tool({"build", "pm", path("a.glb"), "--placement", "optimal", "-o", path("m.vfm")});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_NE(result.err.find("placement kept"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace varifold
