// varifold morph: its JSON, its file, its refusals.
#include <gtest/gtest.h>
#include <tests/cli/run_tool.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/mesh/validation.h>
#include <fstream>

namespace varifold {
namespace {

using nlohmann::json;
using test::run_tool;
using test::TemporaryFolder;
using test::ToolResult;

class MorphCommand : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }

  void make_mesh(const std::string& name, const char* shape, const char* seed = nullptr) const {
    std::vector<std::string> arguments{"generate", shape, "--triangles", "2000", "-o", path(name)};
    if (seed != nullptr) arguments.insert(arguments.end(), {"--seed", seed});
    const ToolResult result = run_tool(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  [[nodiscard]] ToolResult morph(std::vector<std::string> options) const {
    std::vector<std::string> arguments{"morph", path("a.ply"), path("b.ply"), "-o",
                                       path("super.glb")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_tool(arguments);
  }

  TemporaryFolder folder_;
};

TEST_F(MorphCommand, WritesBothShapes) {
  make_mesh("a.ply", "planet", "1");
  make_mesh("b.ply", "planet", "2");
  const ToolResult result = morph({"--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json told = result.json();
  for (const char* const key : {"vertices", "triangles", "input_vertices", "input_triangles",
                                "overlay_triangles", "seconds", "max_error", "rms"})
    EXPECT_TRUE(told.contains(key)) << key;
  EXPECT_LE(told["max_error"], 1e-4);
  EXPECT_EQ(told["flipped_on_sphere"], 0);
  const auto super = read_mesh(path("super.glb"));
  ASSERT_TRUE(super) << super.error().message;
  EXPECT_EQ(told["triangles"], super->mesh.triangle_count());
  ASSERT_EQ(super->mesh.poses.size(), 1u);
  EXPECT_EQ(super->mesh.poses[0].positions.size(), super->mesh.positions.size());
  EXPECT_TRUE(is_sound(validate(super->mesh)));
}

TEST_F(MorphCommand, FeaturesAreReadAndChecked) {
  make_mesh("a.ply", "planet", "1");
  make_mesh("b.ply", "planet", "2");
  const auto with = [&](const std::string& text) {
    std::ofstream(path("features.txt")) << text;
    return morph({"--features", path("features.txt"), "--json"});
  };
  EXPECT_EQ(with("# none yet\n\n3 3  # the nose\n").exit_code, 0);
  EXPECT_EQ(with("3\n").exit_code, 3);
  EXPECT_EQ(with("3 -1\n").exit_code, 3);
  EXPECT_EQ(with("3 4 5\n").exit_code, 3);
  EXPECT_EQ(with("3 1000000\n").exit_code, 3);
  EXPECT_EQ(morph({"--features", path("none.txt")}).exit_code, 3);
}

TEST_F(MorphCommand, RefusesWhatIsNoSphere) {
  make_mesh("a.ply", "planet", "1");
  make_mesh("b.ply", "torus");
  const ToolResult handles = morph({});
  EXPECT_EQ(handles.exit_code, 3);
  EXPECT_NE(handles.err.find("genus 1"), std::string::npos) << handles.err;
  make_mesh("b.ply", "plane");
  EXPECT_EQ(morph({"--no-repair"}).exit_code, 3);
  const ToolResult closed = morph({});
  EXPECT_EQ(closed.exit_code, 0) << closed.err;
  EXPECT_NE(closed.err.find("1 holes closed"), std::string::npos) << closed.err;
}

}  // namespace
}  // namespace varifold
