// varifold morph: its JSON, its file, its refusals.
#include <gtest/gtest.h>
#include <tests/cli/run_tool.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/mesh/topology.h>
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

TEST_F(MorphCommand, KeepsDiscsOpen) {
  make_mesh("a.ply", "terrain", "1");
  make_mesh("b.ply", "plane");
  const auto loops_of = [&] {
    const auto super = read_mesh(path("super.glb"));
    EXPECT_TRUE(super);
    return analyze_topology(super->mesh, weld_points(super->mesh)).boundary_loops;
  };
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--json"},
                                                  {"--json", "--no-repair"},
                                                  {"--json", "--boundary", "keep"}}) {
    const ToolResult result = morph(options);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_LE(result.json()["max_error"], 1e-4);
    EXPECT_EQ(result.json()["discs"], true);
    EXPECT_EQ(loops_of(), 1u);
  }
  const ToolResult closed = morph({"--boundary", "close"});
  ASSERT_EQ(closed.exit_code, 0) << closed.err;
  EXPECT_NE(closed.err.find("1 holes closed"), std::string::npos) << closed.err;
  EXPECT_EQ(loops_of(), 0u);
  make_mesh("b.ply", "planet", "2");
  const ToolResult unlike = morph({"--boundary", "keep"});
  EXPECT_EQ(unlike.exit_code, 3);
  EXPECT_NE(unlike.err.find("open, with 1 hole, but the second mesh is closed"), std::string::npos)
      << unlike.err;
  EXPECT_EQ(morph({"--boundary", "some"}).exit_code, 2);
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
