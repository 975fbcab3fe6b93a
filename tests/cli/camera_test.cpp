// Camera paths on the command line: generate path, bench --test camera, render --path; terrain of
// height maps.
#include <gtest/gtest.h>

#include <tests/cli/run_tool.h>
#include <tests/support/test_files.h>
#include <varifold/io/camera_path_file.h>
#include <varifold/io/mesh_file.h>
#include <varifold/view/known_paths.h>
#include <algorithm>
#include <cmath>
#include <fstream>

namespace varifold {
namespace {

using nlohmann::json;
using test::run_tool;
using test::TemporaryFolder;
using test::ToolResult;

class CameraCommands : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  void make_model(const char* kind, const char* name) const {
    ASSERT_EQ(
        run_tool({"generate", "planet", "--triangles", "4000", "-o", path("m.ply")}).exit_code, 0);
    ASSERT_EQ(run_tool({"build", kind, path("m.ply"), "-o", path(name)}).exit_code, 0);
  }
  [[nodiscard]] static json run_json(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const ToolResult result = run_tool(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.json();
  }
  [[nodiscard]] json bench(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"bench", path("m.vfm"), "--test", "camera"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_json(arguments)["results"][0];
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
  }

  TemporaryFolder folder_;
};

TEST_F(CameraCommands, GenerateEveryPath) {
  for (const std::string_view name : known_path_names()) {
    const json told =
        run_json({"generate", "path", std::string(name), "--frames", "40", "-o", path("p.json")});
    EXPECT_EQ(told["frames"], 40);
    const auto read = read_camera_path(path("p.json"));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->name, name);
    EXPECT_EQ(read->keys.size(), told["keys"]);
  }
  (void)run_json({"generate", "path", "orbit", "--distance", "0.6", "--size", "64x48", "--fovy",
                  "60", "-o", path("p.json")});
  const auto near = read_camera_path(path("p.json"));
  ASSERT_TRUE(near);
  EXPECT_NEAR(glm::length(near->keys[77].eye), 0.6, 1e-12);
  EXPECT_EQ(near->height, 48);
  EXPECT_EQ(near->keys[77].fovy_degrees, 60);
}

TEST_F(CameraCommands, BenchHasTheKeysOfTheContract) {
  make_model("strips", "m.vfm");
  const json told = bench({"--path", "orbit", "--pixels", "2", "--per-frame"});
  for (const char* const key :
       {"kind", "test", "steps", "seconds_total", "seconds_extraction", "seconds_drawing",
        "collapses_per_second", "indices_submitted", "bytes_per_vertex", "frames", "adapt_ms_p50",
        "adapt_ms_p99", "triangles_mean", "max_jump_pixels"})
    EXPECT_TRUE(told.contains(key)) << key;
  EXPECT_EQ(told["frames"], 360);
  EXPECT_EQ(told["width"], 1920);
  EXPECT_LE(told["adapt_ms_p50"], told["adapt_ms_p90"]);
  EXPECT_LE(told["adapt_ms_p99"], told["adapt_ms_max"]);
  const json& frames = told["per_frame"];
  ASSERT_EQ(frames.size(), 360u);
  double triangles = 0, jump = 0;
  std::uint64_t splits = 0;
  for (const json& frame : frames) {
    triangles += frame["triangles"].get<double>();
    jump = std::max(jump, frame["jump_pixels"].get<double>());
    if (frame["frame"] != 0) splits += frame["splits"].get<std::uint64_t>();
    EXPECT_EQ(frame["tolerance_pixels"], 2.0);
    EXPECT_LE(frame["surface_jump_pixels"], frame["jump_pixels"]);
  }
  EXPECT_NEAR(told["triangles_mean"], triangles / 360, 1e-6);
  EXPECT_EQ(told["max_jump_pixels"], jump);
  EXPECT_EQ(told["splits"], splits);
  EXPECT_GT(splits, 0u);
  EXPECT_GT(jump, 0);
  // An error of two pixels, and little of it at once.
  EXPECT_LT(told["max_surface_jump_pixels"], 6);
}

TEST_F(CameraCommands, TheSameFramesEveryTime) {
  make_model("strips", "m.vfm");
  const json once = bench({"--path", "dive"}), again = bench({"--path", "dive"});
  EXPECT_EQ(once["frames_checksum"], again["frames_checksum"]);
  EXPECT_EQ(once["max_jump_pixels"], again["max_jump_pixels"]);
  const json small = bench({"--path", "dive", "--size", "320x180"});
  EXPECT_NE(once["frames_checksum"], small["frames_checksum"]);
  EXPECT_LT(small["triangles_mean"], once["triangles_mean"]);
  // A known path and its file are one.
  (void)run_json({"generate", "path", "dive", "-o", path("p.json")});
  EXPECT_EQ(bench({"--path", path("p.json")})["frames_checksum"], once["frames_checksum"]);
}

TEST_F(CameraCommands, GoalsAndCriteria) {
  make_model("strips", "m.vfm");
  const json goal = bench({"--path", "orbit", "--triangles", "1000"});
  EXPECT_LE(goal["triangles_max"], 1000);
  EXPECT_LT(goal["goal_error_max"], 0.1);
  EXPECT_LE(goal["goal_error_mean"], goal["goal_error_max"]);
  const json all = bench({"--path", "orbit"});
  const json around = bench({"--path", "orbit", "--no-frustum", "--no-orientation"});
  EXPECT_GT(around["triangles_mean"], all["triangles_mean"]);
}

TEST_F(CameraCommands, StripsOfAFront) {
  make_model("vdpm", "m.vfm");
  const json list = bench({"--path", "orbit", "--per-frame"});
  const json strips = bench({"--path", "orbit", "--strips", "--per-frame"});
  EXPECT_EQ(list["strips"], false);
  EXPECT_EQ(list["strips_mean"], 0);
  EXPECT_EQ(list["indices_per_triangle"], 3);
  EXPECT_EQ(strips["strips"], true);
  EXPECT_EQ(strips["frames_checksum"], list["frames_checksum"]);
  EXPECT_EQ(strips["max_jump_pixels"], list["max_jump_pixels"]);
  EXPECT_LT(strips["indices_per_triangle"], 2);
  EXPECT_GT(strips["triangles_per_strip"], 5);
  EXPECT_LT(strips["acmr_16"], list["acmr_16"]);
  EXPECT_GE(strips["acmr_16"], strips["acmr_24"]);
  EXPECT_GT(strips["acmr_24"], 0.5);
  // All indices of each front where something has changed, at least.
  for (std::size_t i = 1; i < strips["per_frame"].size(); ++i) {
    const json& frame = strips["per_frame"][i];
    if (frame["splits"].get<int>() + frame["collapses"].get<int>() > 0) {
      EXPECT_GE(frame["changed_bytes"], 4 * frame["indices_submitted"].get<std::uint64_t>()) << i;
    } else {
      EXPECT_EQ(frame["changed_bytes"], 0) << i;
    }
    EXPECT_GT(frame["strips"], 0);
  }
  make_model("strips", "m.vfm");
  const ToolResult wrong =
      run_tool({"bench", path("m.vfm"), "--test", "camera", "--path", "orbit", "--strips"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("--strips"), std::string::npos);
  EXPECT_EQ(run_tool({"bench", path("m.vfm"), "--strips"}).exit_code, 2);
}

TEST_F(CameraCommands, ModelsOfEveryKindFollow) {
  for (const char* const kind : {"pm", "lodstrips", "mts", "strips"}) {
    make_model(kind, "m.vfm");
    const json told = bench({"--path", "fly_by", "--pixels", "3"});
    EXPECT_EQ(told["kind"], kind);
    EXPECT_GT(told["splits"], 0) << kind;
    EXPECT_GT(told["max_jump_pixels"], 0) << kind;
    EXPECT_LE(told["tolerance_pixels_max"], 3.0001) << kind;
  }
}

TEST_F(CameraCommands, BadPathsAreBadInput) {
  make_model("strips", "m.vfm");
  const auto refused = [&](const std::string& text, const std::string& part) {
    write("p.json", text);
    for (const bool is_bench : {true, false}) {
      const ToolResult result =
          is_bench
              ? run_tool({"bench", path("m.vfm"), "--test", "camera", "--path", path("p.json")})
              : run_tool({"extract", path("m.vfm"), "--pixels", "1", "--path", path("p.json"),
                          "--frame", "1", "-o", path("o.ply")});
      EXPECT_EQ(result.exit_code, 3) << text << result.err;
      EXPECT_EQ(test::lines_of(result.err).size(), 1u) << result.err;
      EXPECT_NE(result.err.find("p.json"), std::string::npos) << result.err;
      EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    }
  };
  const std::string start = R"({"varifold_camera_path": 1, "keys": [{"eye": [0, 0, 2]}, )";
  refused("", "not valid JSON");
  refused(start + R"({"eye": [0, 0, 0]}]})", "frame 1: eye and target are one point");
  refused(start + R"({"eye": [0, 0, 1], "fovy_degrees": 0}]})", "frame 1: the angle of view");
  refused(start + R"({"eye": [0, 0, NaN]}]})", "line 1");
  refused(start + R"({"eye": [0, 3, 0]}]})", "frame 1: up is along");
  EXPECT_EQ(
      run_tool({"bench", path("m.vfm"), "--test", "camera", "--path", path("none.json")}).exit_code,
      3);
}

TEST_F(CameraCommands, WrongUsage) {
  make_model("pm", "m.vfm");
  const std::string model = path("m.vfm"), out = path("o.json"), mesh = path("o.ply");
  const std::vector<std::vector<std::string>> all{
      {"generate", "path", "-o", out},
      {"generate", "path", "spiral", "-o", out},
      {"generate", "path", "dive", "--distance", "3", "-o", out},
      {"generate", "path", "orbit", "--frames", "1", "-o", out},
      {"generate", "path", "orbit", "--triangles", "5", "-o", out},
      {"generate", "planet", "orbit", "-o", mesh},
      {"generate", "planet", "--frames", "9", "-o", mesh},
      {"generate", "terrain", "--size", "9x9", "-o", mesh},
      {"generate", "terrain", "--height-scale", "1", "-o", mesh},
      {"generate", "terrain", "--heightmap", mesh, "--size", "1x9", "-o", mesh},
      {"generate", "terrain", "--heightmap", mesh, "--size", "9x9", "--triangles", "9", "-o", mesh},
      {"bench", model, "--test", "camera"},
      {"bench", model, "--test", "camera", "--path", "orbit", "--steps", "5"},
      {"bench", model, "--test", "linear", "--path", "orbit"},
      {"bench", model, "--test", "camera", "--path", "orbit", "--pixels", "-1"},
      {"extract", model, "--pixels", "1", "--path", "orbit", "--eye", "0,0,5", "-o", mesh},
      {"extract", model, "--pixels", "1", "--frame", "5", "-o", mesh},
      {"extract", model, "--pixels", "1", "--path", "orbit", "--frame", "360", "-o", mesh}};
  for (const auto& arguments : all) {
    const ToolResult result = run_tool(arguments);
    EXPECT_EQ(result.exit_code, 2) << ::testing::PrintToString(arguments) << result.err;
    EXPECT_EQ(test::lines_of(result.err).size(), 1u) << result.err;
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(CameraCommands, RenderAndBenchDrawFrames) {
  make_model("strips", "m.vfm");
  const ToolResult drawn =
      run_tool({"render", path("m.vfm"), "--path", "orbit", "--frame", "90", "--pixels", "2",
                "--size", "96x64", "-o", path("m.png"), "--json"});
  if (drawn.exit_code == 1 && drawn.err.find("EGL") != std::string::npos)
    GTEST_SKIP() << "no OpenGL here: " << drawn.err;
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_EQ(drawn.json()["width"], 96);
  const json told = bench({"--path", "fly_by", "--size", "96x64", "--draw", "multi"});
  EXPECT_GT(told["seconds_drawing"], 0);
  EXPECT_EQ(told["draw"], "multi");
}

TEST_F(CameraCommands, TerrainOfAHeightMap) {
  VARIFOLD_REAL_MESH_OR_SKIP(map, "gcanyon_elevation.png");
  const json full = run_json({"generate", "terrain", "--heightmap", map, "--size", "600x600",
                              "--height-scale", "0.15", "-o", path("t.ply")});
  EXPECT_EQ(full["vertices"], 360000);
  EXPECT_EQ(full["triangles"], 2 * 599 * 599);
  const auto terrain = read_mesh(path("t.ply"));
  ASSERT_TRUE(terrain);
  Box box;
  for (const Vec3& p : terrain->mesh.positions) box.add(p);
  EXPECT_NEAR(box.lower.x, -1, 1e-5);
  EXPECT_NEAR(box.upper.z, 1, 1e-5);
  EXPECT_GT(box.upper.y, 0.2f);
  EXPECT_LE(box.upper.y, 0.3f);

  // The flight is over the ground all the time, and low.
  const auto flight = known_path("canyon");
  ASSERT_TRUE(flight);
  const auto cameras = cameras_of(*flight, box);
  ASSERT_TRUE(cameras) << cameras.error().message;
  float least = 1e9f, most = 0;
  for (const Camera& camera : *cameras) {
    const auto cell = [](float x) {
      return static_cast<std::size_t>(std::lround((x + 1) * 299.5f));
    };
    ASSERT_LE(std::abs(camera.eye.x), 1);
    ASSERT_LE(std::abs(camera.eye.z), 1);
    const Vec3 ground = terrain->mesh.positions[cell(camera.eye.z) * 600 + cell(camera.eye.x)];
    EXPECT_NEAR(ground.x, camera.eye.x, 0.002f);
    least = std::min(least, camera.eye.y - ground.y);
    most = std::max(most, camera.eye.y - ground.y);
  }
  EXPECT_GT(least, 0.01f);
  EXPECT_LT(most, 0.15f);

  const json some = run_json(
      {"generate", "terrain", "--heightmap", map, "--triangles", "20000", "-o", path("t.ply")});
  EXPECT_EQ(some["triangles"], 20000);
}

TEST_F(CameraCommands, BadHeightMapsAreBadInput) {
  write("bad.png", "no picture");
  const ToolResult result =
      run_tool({"generate", "terrain", "--heightmap", path("bad.png"), "-o", path("t.ply")});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("bad.png: not a PNG file"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace varifold
