// Every command: its JSON, its files, its exit code.
#include <gtest/gtest.h>

#include <tests/cli/run_tool.h>
#include <tests/support/meshes.h>
#include <tests/support/rigged_meshes.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/mesh/validation.h>
#include <fstream>
#include <initializer_list>

namespace varifold {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::run_tool;
using test::TemporaryFolder;
using test::ToolResult;

class Commands : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }

  /// Runs with --json, expects it to succeed with these keys.
  [[nodiscard]] static json run_json(std::vector<std::string> arguments,
                                     std::initializer_list<const char*> keys) {
    arguments.emplace_back("--json");
    const ToolResult result = run_tool(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    json object = result.json();
    EXPECT_TRUE(object.is_object()) << result.out;
    EXPECT_EQ(test::lines_of(result.out).size(), 1u);
    for (const char* const key : keys) EXPECT_TRUE(object.contains(key)) << key;
    return object;
  }

  void make_mesh(const std::string& name, const char* shape = "planet",
                 const char* triangles = "5000") const {
    const ToolResult result =
        run_tool({"generate", shape, "--triangles", triangles, "-o", path(name)});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  void make_model(const std::string& mesh, const std::string& model) const {
    const ToolResult result = run_tool({"build", "pm", path(mesh), "-o", path(model)});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }

  TemporaryFolder folder_;
};

TEST_F(Commands, GenerateEveryShape) {
  for (const char* shape :
       {"planet", "terrain", "sphere", "torus", "knot", "plane", "box", "seamed_sphere"}) {
    const json told = run_json({"generate", shape, "--triangles", "500", "-o", path("m.glb")},
                               {"shape", "vertices", "triangles", "seconds"});
    const auto mesh = read_mesh(path("m.glb"));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(told["triangles"], mesh->mesh.triangle_count()) << shape;
    EXPECT_TRUE(is_sound(validate(mesh->mesh))) << shape;
  }
}

TEST_F(Commands, GenerateTheSameBytesForASeed) {
  const auto generate = [&](const char* seed, const char* threads) {
    const ToolResult result = run_tool({"generate", "planet", "--triangles", "2000", "--seed", seed,
                                        "--threads", threads, "-o", path("m.ply")});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return bytes_of(path("m.ply"));
  };
  EXPECT_EQ(generate("7", "1"), generate("7", "3"));
  EXPECT_NE(generate("7", "1"), generate("8", "1"));
}

TEST_F(Commands, InfoOfAMesh) {
  make_mesh("box.obj", "box", "300");
  const json told = run_json(
      {"info", path("box.obj")},
      {"vertices", "triangles", "bounds", "attributes", "materials", "topology", "warnings"});
  EXPECT_EQ(told["type"], "mesh");
  EXPECT_EQ(told["topology"]["closed"], true);
  EXPECT_EQ(told["topology"]["genus"], 0);
  EXPECT_EQ(told["attributes"], json({"normals", "texcoords"}));
}

TEST_F(Commands, InfoOfWhatMoves) {
  const TriangleMesh mesh = test::with_random_rig(test::icosphere(80), 1, {2, 5, 2});
  ASSERT_TRUE(write_mesh(mesh, path("m.glb")));
  const json told = run_json({"info", path("m.glb")}, {"poses", "joints", "animations"});
  EXPECT_EQ(told["poses"], 2);
  EXPECT_EQ(told["joints"], 5);
  EXPECT_EQ(told["animations"], 2);
  EXPECT_EQ(told["pose_names"], json({"pose 0", "pose 1"}));
  EXPECT_EQ(told["animation_list"][1]["name"], "animation 1");
  EXPECT_EQ(told["attributes"], json({"normals", "skin"}));
  EXPECT_NE(run_tool({"info", path("m.glb")}).out.find("animation 0"), std::string::npos);
  make_mesh("still.ply");
  const json still = run_json({"info", path("still.ply")}, {"poses", "joints", "animations"});
  EXPECT_EQ(still["poses"], 0);
}

TEST_F(Commands, InfoOfAModel) {
  make_mesh("m.ply");
  make_model("m.ply", "m.vfm");
  const json told = run_json({"info", path("m.vfm")},
                             {"kind", "vertices", "triangles", "levels", "base_triangles",
                              "base_error", "chunks", "bytes_per_vertex", "file_bytes"});
  EXPECT_EQ(told["kind"], "pm");
  EXPECT_EQ(told["file_bytes"], std::filesystem::file_size(path("m.vfm")));
}

TEST_F(Commands, BenchInThreeWays) {
  make_mesh("m.ply");
  make_model("m.ply", "m.vfm");
  for (const char* test : {"linear", "exponential", "random"}) {
    const json told = run_json(
        {"bench", path("m.vfm"), path("m.vfm"), "--test", test, "--steps", "40", "--draw", "none"},
        {"results"});
    ASSERT_EQ(told["results"].size(), 2u);
    const json& result = told["results"][0];
    for (const char* key :
         {"kind", "test", "steps", "seconds_total", "seconds_extraction", "seconds_drawing",
          "collapses_per_second", "indices_submitted", "bytes_per_vertex"})
      EXPECT_TRUE(result.contains(key)) << key;
    EXPECT_EQ(result["test"], test);
    EXPECT_EQ(result["steps"], 40);
    EXPECT_GT(result["collapses"], 0);
    EXPECT_EQ(result["collapses"], told["results"][1]["collapses"]);
    EXPECT_EQ(result["indices_submitted"], told["results"][1]["indices_submitted"]);
  }
}

TEST_F(Commands, SimplifyToTriangles) {
  make_mesh("m.ply");
  const json told = run_json(
      {"simplify", path("m.ply"), "--triangles", "700", "-o", path("s.obj")},
      {"triangles", "rms_error", "max_error", "stop_reason", "seconds", "vertices", "bound_error"});
  EXPECT_LE(told["triangles"], 700);
  EXPECT_GE(told["triangles"], 698);
  EXPECT_EQ(told["stop_reason"], "target_reached");
  EXPECT_LE(told["rms_error"], told["max_error"]);
  const auto mesh = read_mesh(path("s.obj"));
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->mesh.triangle_count(), told["triangles"]);
  EXPECT_TRUE(is_sound(validate(mesh->mesh)));
}

TEST_F(Commands, SimplifyByRatioAndByError) {
  make_mesh("m.ply");
  const json half =
      run_json({"simplify", path("m.ply"), "--ratio", "0.5", "-o", path("s.ply")}, {"triangles"});
  EXPECT_NEAR(half["triangles"].get<double>(), 2500, 60);
  const json near = run_json(
      {"simplify", path("m.ply"), "--error", "0.01", "--placement", "optimal", "-o", path("s.ply")},
      {"bound_error"});
  EXPECT_EQ(near["stop_reason"], "error_reached");
  EXPECT_LE(near["bound_error"], 0.0100001);
}

TEST_F(Commands, TheMetricDecidesTheOrder) {
  make_mesh("m.ply");
  const auto simplified = [&](std::vector<std::string> options) {
    options.insert(options.begin(),
                   {"simplify", path("m.ply"), "--ratio", "0.2", "-o", path("s.ply")});
    (void)run_json(options, {"rms_error"});
    return bytes_of(path("s.ply"));
  };
  const std::string energy = simplified({"--metric", "energy"});
  EXPECT_EQ(energy, simplified({"--metric", "energy", "--threads", "2"}));
  EXPECT_NE(energy, simplified({"--metric", "quadric"}));
  EXPECT_NE(energy, simplified({"--metric", "energy", "--energy-samples", "3"}));
}

TEST_F(Commands, RefusesMetricsByName) {
  make_mesh("m.ply");
  const ToolResult unknown =
      run_tool({"build", "pm", path("m.ply"), "--metric", "volume", "-o", path("m.vfm")});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("--metric"), std::string::npos) << unknown.err;
  const ToolResult unused =
      run_tool({"build", "pm", path("m.ply"), "--energy-samples", "2", "-o", path("m.vfm")});
  EXPECT_EQ(unused.exit_code, 2);
  EXPECT_NE(unused.err.find("--metric energy"), std::string::npos) << unused.err;
}

TEST_F(Commands, SimplifySaysWhyItIsStuck) {
  // Open at every edge: nothing but borders and corners.
  make_mesh("sphere.obj", "seamed_sphere", "2000");
  const ToolResult stuck = run_tool({"simplify", path("sphere.obj"), "--triangles", "20",
                                     "--strict", "--json", "-o", path("s.ply")});
  EXPECT_EQ(stuck.exit_code, 1);
  const json told = stuck.json();
  ASSERT_EQ(told["stop_reason"], "stuck") << stuck.out;
  EXPECT_TRUE(told["left_by_kind"].is_object());
  EXPECT_TRUE(told["refusals"].is_object());
  EXPECT_FALSE(told["advice"].get<std::string>().empty());
  EXPECT_NE(stuck.err.find("stuck at"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(path("s.ply")));

  // What the advice names helps.
  const json helped = run_json({"simplify", path("sphere.obj"), "--triangles", "20", "--ignore",
                                "texcoords,materials", "-o", path("s.ply")},
                               {});
  EXPECT_EQ(helped["stop_reason"], "target_reached");
}

TEST_F(Commands, WeldingClosesCracks) {
  // A square whose two triangles miss each other by a little.
  std::ofstream(path("crack.obj")) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.001 0 0\nv 1.001 1 0\n"
                                      "v 0 1 0\nf 1 2 3\nf 4 5 6\n";
  const json apart = run_json({"info", path("crack.obj")}, {});
  EXPECT_EQ(apart["topology"]["components"], 2);
  (void)run_json(
      {"simplify", path("crack.obj"), "--ratio", "1", "--weld", "0.01", "-o", path("whole.ply")},
      {});
  const json whole = run_json({"info", path("whole.ply")}, {});
  EXPECT_EQ(whole["topology"]["components"], 1);
  EXPECT_EQ(whole["topology"]["positions"], 4);
}

TEST_F(Commands, BuildHasTheKeysOfTheContract) {
  make_mesh("m.ply");
  const json told = run_json({"build", "pm", path("m.ply"), "-o", path("m.vfm")},
                             {"kind", "vertices", "triangles", "seconds", "simplify_seconds",
                              "peak_rss_bytes", "model_bytes", "file_bytes", "bytes_per_vertex",
                              "base_vertices", "base_triangles", "levels", "position_error"});
  EXPECT_EQ(told["kind"], "pm");
  EXPECT_EQ(told["position_error"], 0);
  EXPECT_EQ(told["file_bytes"], std::filesystem::file_size(path("m.vfm")));
}

TEST_F(Commands, BuildTheSameBytesForAnyNumberOfThreads) {
  make_mesh("m.ply", "planet", "60000");
  const auto build = [&](const char* threads) {
    const ToolResult result =
        run_tool({"build", "pm", path("m.ply"), "--threads", threads, "-o", path("m.vfm")});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return bytes_of(path("m.vfm"));
  };
  const std::string one = build("1");
  EXPECT_FALSE(one.empty());
  EXPECT_TRUE(one == build("3"));
}

TEST_F(Commands, BuildOptionsMakeSoundModels) {
  make_mesh("m.glb", "seamed_sphere", "3000");
  const std::vector<std::vector<std::string>> all{
      {"--position-bits", "14", "--normal-bits", "10", "--texcoord-bits", "12", "--compress"},
      {"--placement", "optimal"},
      {"--metric", "energy"},
      {"--metric", "energy", "--placement", "optimal", "--energy-samples", "0.5"},
      {"--no-measure"},
      {"--normal-weight", "0", "--texcoord-weight", "0.1"},
      {"--ignore", "normals,texcoords,materials"}};
  for (std::vector<std::string> options : all) {
    options.insert(options.begin(), {"build", "pm", path("m.glb"), "-o", path("m.vfm")});
    const json told = run_json(options, {"position_error"});
    EXPECT_EQ(told["position_error"] > 0.0, options[5] == "--position-bits");
    const json checked = run_json({"check", path("m.vfm")}, {"sound", "faults"});
    EXPECT_EQ(checked["sound"], true) << options[5] << checked;
    EXPECT_GT(checked["levels_checked"], 10);
  }
}

TEST_F(Commands, ExtractEveryKindOfLevel) {
  make_mesh("m.ply");
  make_model("m.ply", "m.vfm");
  const auto extract = [&](std::vector<std::string> level) {
    level.insert(level.begin(), {"extract", path("m.vfm"), "-o", path("l.ply")});
    return run_json(level, {"kind", "vertices", "triangles", "seconds"});
  };
  EXPECT_EQ(extract({"--lod", "1"})["triangles"], 5120);
  EXPECT_EQ(extract({"--lod", "0"})["triangles"], 4);
  EXPECT_EQ(extract({"--triangles", "1000"})["triangles"], 1000);
  EXPECT_EQ(extract({"--vertices", "300"})["vertices"], 300);
  EXPECT_LE(extract({"--error", "0.02"})["error"], 0.02);
  const auto mesh = read_mesh(path("l.ply"));
  ASSERT_TRUE(mesh);
  EXPECT_TRUE(validate(mesh->mesh).empty());
}

TEST_F(Commands, ExtractForAView) {
  make_mesh("m.ply");
  make_model("m.ply", "m.vfm");
  const auto extract = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"extract", path("m.vfm"), "-o", path("l.ply"), "--size", "800x600",
                               "--target", "0,0,0", "--fovy", "40"});
    return run_json(more, {"triangles", "pixel_error", "forced_splits"});
  };
  const json near = extract({"--eye", "-0.5,.25,3", "--pixels", "2"});
  const json far = extract({"--eye", "-5,2.5,30", "--pixels", "2"});
  EXPECT_LE(near["pixel_error"], 2);
  EXPECT_LE(far["pixel_error"], 2);
  EXPECT_LT(far["triangles"], near["triangles"]);
  EXPECT_GT(far["triangles"], 4);
  const json capped = extract({"--eye", "-0.5,.25,3", "--pixels", "2", "--triangles", "100"});
  EXPECT_LE(capped["triangles"], 100);
  // Inside the mesh everything is near.
  EXPECT_EQ(extract({"--eye", "0,0,0.1", "--pixels", "2"})["triangles"], 5120);
}

TEST_F(Commands, ModelsFromStandardInput) {
  make_mesh("m.ply");
  make_model("m.ply", "m.vfm");
  test::ToolOptions piped;
  piped.input = path("m.vfm");
  const ToolResult extracted =
      run_tool({"extract", "-", "--triangles", "500", "-o", path("l.ply"), "--json"}, piped);
  EXPECT_EQ(extracted.exit_code, 0) << extracted.err;
  EXPECT_EQ(extracted.json()["triangles"], 500);
  EXPECT_EQ(run_tool({"info", "-", "--json"}, piped).json()["triangles"], 5120);
}

TEST_F(Commands, CheckListsTheFaultsOfAMesh) {
  std::ofstream(path("bad.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 5 5 5\n"
                                    "f 1 2 3\nf 1 2 4\nf 1 2 3\nf 1 1 2\n";
  const ToolResult result = run_tool({"check", path("bad.obj"), "--json"});
  EXPECT_EQ(result.exit_code, 1);
  const json told = result.json();
  EXPECT_EQ(told["sound"], false);
  ASSERT_FALSE(told["faults"].empty());
  for (const json& fault : told["faults"])
    for (const char* key : {"kind", "count", "where"}) EXPECT_TRUE(fault.contains(key));
}

TEST_F(Commands, CheckClosednessWhereAsked) {
  make_mesh("plane.ply", "plane", "200");
  EXPECT_EQ(run_tool({"check", path("plane.ply")}).exit_code, 0);
  EXPECT_EQ(run_tool({"check", path("plane.ply"), "--closed"}).exit_code, 1);
}

TEST_F(Commands, CheckAgainstTheOriginal) {
  make_mesh("m.ply");
  make_model("m.ply", "m.vfm");
  ASSERT_EQ(
      run_tool({"extract", path("m.vfm"), "--triangles", "800", "-o", path("l.ply")}).exit_code, 0);
  const json told = run_json({"check", path("l.ply"), "--against", path("m.ply"), "--closed"},
                             {"sound", "flipped_triangles", "rms_error", "max_error"});
  EXPECT_EQ(told["flipped_triangles"], 0);
  EXPECT_GT(told["rms_error"], 0);
}

TEST_F(Commands, RenderAMeshAndALevel) {
  make_mesh("m.ply");
  make_model("m.ply", "m.vfm");
  const ToolResult drawn =
      run_tool({"render", path("m.ply"), "-o", path("m.png"), "--size", "320x200", "--json"});
  if (drawn.exit_code == 1 && drawn.err.find("EGL") != std::string::npos)
    GTEST_SKIP() << "no OpenGL here: " << drawn.err;
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_EQ(bytes_of(path("m.png")).substr(1, 3), "PNG");
  const json level =
      run_json({"render", path("m.vfm"), "--pixels", "3", "--wireframe", "--flat", "--color",
                "level", "--eye", "0,0,4", "-o", path("l.png"), "--size", "320x200"},
               {"triangles", "level", "error", "device", "seconds"});
  EXPECT_LT(level["triangles"], 5120);
  EXPECT_EQ(bytes_of(path("l.png")).substr(1, 3), "PNG");
}

TEST_F(Commands, TheBunnyAsInTheReadme) {
  VARIFOLD_REAL_MESH_OR_SKIP(bunny, "bunny.ply");
  const json built = run_json({"build", "pm", bunny, "-o", path("bunny.vfm")}, {});
  EXPECT_EQ(built["triangles"], 69451);
  const json extracted =
      run_json({"extract", path("bunny.vfm"), "--triangles", "5000", "-o", path("b.ply")}, {});
  EXPECT_EQ(extracted["triangles"], 5000);
  EXPECT_EQ(run_json({"check", path("bunny.vfm")}, {})["sound"], true);
  EXPECT_EQ(run_json({"check", path("b.ply"), "--against", bunny}, {})["sound"], true);
}

}  // namespace
}  // namespace varifold
