// Every kind of model through every command that takes models; and bad models of every kind.
#include <gtest/gtest.h>

#include <tests/cli/run_tool.h>
#include <tests/support/test_files.h>
#include <varifold/io/container.h>
#include <varifold/io/mesh_file.h>
#include <varifold/io/model_file.h>
#include <varifold/io/output_file.h>
#include <varifold/mesh/validation.h>
#include <fstream>

namespace varifold {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::lines_of;
using test::run_tool;
using test::TemporaryFolder;
using test::ToolResult;

class Models : public ::testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  [[nodiscard]] static std::string kind() { return GetParam(); }

  [[nodiscard]] static json run_json(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const ToolResult result = run_tool(arguments);
    EXPECT_EQ(result.exit_code, 0) << ::testing::PrintToString(arguments) << result.err;
    return result.json();
  }
  [[nodiscard]] json make_model(const char* shape = "planet",
                                const char* triangles = "3000") const {
    EXPECT_EQ(
        run_tool({"generate", shape, "--triangles", triangles, "-o", path("m.glb")}).exit_code, 0);
    return run_json({"build", kind(), path("m.glb"), "-o", path("m.vfm")});
  }
  void expect_refused(const std::string& name) const {
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"info", path(name)},
                                               {"check", path(name)},
                                               {"bench", path(name), "--draw", "none"}}) {
      const ToolResult result = run_tool(arguments);
      EXPECT_EQ(result.exit_code, 3) << result.err;
      const auto lines = lines_of(result.err);
      ASSERT_EQ(lines.size(), 1u) << result.err;
      EXPECT_NE(lines[0].find(name), std::string::npos) << lines[0];
    }
  }

  TemporaryFolder folder_;
};

// What single kinds have beyond the others.
class StripModels : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  json make(const std::string& kind, const std::vector<std::string>& more) const {
    EXPECT_EQ(
        run_tool({"generate", "planet", "--triangles", "6000", "-o", path("m.glb")}).exit_code, 0);
    std::vector<std::string> arguments = {"build", kind,          path("m.glb"),
                                          "-o",    path("m.vfm"), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ToolResult result = run_tool(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.json();
  }

  TemporaryFolder folder_;
};

TEST_P(Models, BuildHasTheKeysOfTheContract) {
  const json told = make_model();
  for (const char* key :
       {"kind", "vertices", "triangles", "seconds", "simplify_seconds", "peak_rss_bytes",
        "model_bytes", "file_bytes", "bytes_per_vertex", "levels", "error_is_measured"})
    EXPECT_TRUE(told.contains(key)) << key;
  EXPECT_EQ(told["kind"], kind());
  EXPECT_EQ(told["file_bytes"], std::filesystem::file_size(path("m.vfm")));
  if (kind() == "pm") return;
  EXPECT_GT(told["strips"], 0);
  EXPECT_GT(told["indices_per_triangle"], 1.0);
  EXPECT_LT(told["indices_per_triangle"], 2.2);
}

TEST_P(Models, TheSameBytesForAnyNumberOfThreads) {
  ASSERT_EQ(run_tool({"generate", "planet", "--triangles", "20000", "-o", path("m.ply")}).exit_code,
            0);
  const auto build = [&](const char* threads) {
    const ToolResult result =
        run_tool({"build", kind(), path("m.ply"), "--threads", threads, "-o", path("m.vfm")});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return bytes_of(path("m.vfm"));
  };
  const std::string one = build("1");
  EXPECT_FALSE(one.empty());
  EXPECT_TRUE(one == build("3"));
}

TEST_P(Models, InfoExtractAndCheck) {
  for (const char* shape : {"planet", "seamed_sphere", "terrain", "box"}) {
    const json told = make_model(shape);
    const json info = run_json({"info", path("m.vfm")});
    EXPECT_EQ(info["kind"], kind());
    EXPECT_EQ(info["triangles"], told["triangles"]);
    EXPECT_EQ(info["base_triangles"], told["base_triangles"]);
    const json checked = run_json({"check", path("m.vfm")});
    EXPECT_EQ(checked["sound"], true) << shape << checked;
    EXPECT_EQ(checked["kind"], kind());
    EXPECT_GT(checked["levels_checked"], 10);

    const json level = run_json({"extract", path("m.vfm"), "--lod", "0.4", "-o", path("l.ply")});
    EXPECT_EQ(level["kind"], kind());
    const auto mesh = read_mesh(path("l.ply"));
    ASSERT_TRUE(mesh);
    EXPECT_TRUE(is_sound(validate(mesh->mesh))) << shape;
    EXPECT_EQ(mesh->mesh.triangle_count(), level["triangles"]);

    // The same level of the progressive mesh of the same sequence.
    (void)run_json({"build", "pm", path("m.glb"), "-o", path("pm.vfm")});
    const json same = run_json({"extract", path("pm.vfm"), "--lod", "0.4", "-o", path("p.ply")});
    for (const char* key : {"level", "finest_level", "vertices", "triangles", "error"})
      EXPECT_EQ(level[key], same[key]) << shape << " " << key;
  }
}

TEST_P(Models, RenderInColoursOfStrips) {
  (void)make_model();
  const ToolResult drawn = run_tool({"render", path("m.vfm"), "--color", "strip", "--triangles",
                                     "900", "-o", path("m.png"), "--size", "200x150", "--json"});
  if (drawn.exit_code == 1 && drawn.err.find("EGL") != std::string::npos)
    GTEST_SKIP() << "no OpenGL here: " << drawn.err;
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_EQ(drawn.json()["kind"], kind());
  EXPECT_EQ(drawn.json()["triangles"], 900);
  EXPECT_EQ(bytes_of(path("m.png")).substr(1, 3), "PNG");
}

TEST_P(Models, BenchDrawsOrDoesNot) {
  (void)make_model();
  const auto bench = [&](const char* draw) {
    const ToolResult result = run_tool(
        {"bench", path("m.vfm"), "--test", "linear", "--steps", "250", "--draw", draw, "--json"});
    return result.exit_code == 0 ? result.json()["results"][0] : json();
  };
  const json none = bench("none");
  EXPECT_EQ(none["kind"], kind());
  EXPECT_TRUE(none["seconds_drawing"].is_null());
  EXPECT_EQ(none["extraction_share"], 1.0);
  const json& samples = none["samples"];
  ASSERT_EQ(samples.size(), 101u);
  EXPECT_EQ(samples[0]["step"], 0);
  EXPECT_EQ(samples[100]["step"], 249);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    EXPECT_GT(samples[i]["step"], samples[i - 1]["step"]);
    EXPECT_GE(samples[i]["vertices"], samples[i]["triangles"]);
    EXPECT_GE(samples[i]["indices"], samples[i]["vertices"]);
  }
  const json multi = bench("multi"), strips = bench("strips");
  if (multi.is_null()) GTEST_SKIP() << "no OpenGL here";
  for (const json& drawn : {multi, strips}) {
    EXPECT_GT(drawn["seconds_drawing"], 0);
    EXPECT_EQ(drawn["indices_submitted"], none["indices_submitted"]);
    EXPECT_NEAR(drawn["seconds_total"].get<double>(),
                drawn["seconds_drawing"].get<double>() + drawn["seconds_extraction"].get<double>(),
                1e-9);
  }
  for (const char* key : {"test", "steps", "collapses", "collapses_per_second", "model_bytes",
                          "instance_bytes", "bytes_per_vertex", "device", "draw"})
    EXPECT_TRUE(multi.contains(key)) << key;
}

TEST_P(Models, OneSampleOfOneStep) {
  (void)make_model("torus", "200");
  const json told =
      run_json({"bench", path("m.vfm"), "--steps", "1", "--draw", "none", "--test", "random"});
  EXPECT_EQ(told["results"][0]["samples"].size(), 1u);
}

TEST_P(Models, ThePlaneTestNeedsLevelsPerRegion) {
  (void)make_model();
  const ToolResult result = run_tool(
      {"bench", path("m.vfm"), "--test", "plane", "--steps", "20", "--draw", "none", "--json"});
  if (kind() != "strips") {
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find(kind()), std::string::npos) << result.err;
    return;
  }
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json told = result.json()["results"][0];
  ASSERT_EQ(told["samples"].size(), 20u);
  // The more the plane has passed, the less is drawn; in the end next to nothing.
  EXPECT_GT(told["samples"][0]["indices"], told["samples"][10]["indices"]);
  EXPECT_GT(told["samples"][10]["indices"], told["samples"][19]["indices"]);
}

TEST_P(Models, StripsRefuseOptimalPlacement) {
  (void)make_model("torus", "200");
  const ToolResult result =
      run_tool({"build", kind(), path("m.glb"), "--placement", "optimal", "-o", path("o.vfm")});
  EXPECT_EQ(result.exit_code, kind() == "pm" ? 0 : 2) << result.err;
  EXPECT_EQ(std::filesystem::exists(path("o.vfm")), kind() == "pm");
}

TEST_P(Models, AreBuiltByEnergyToo) {
  (void)make_model("torus", "400");
  (void)run_json({"build", kind(), path("m.glb"), "--metric", "energy", "-o", path("o.vfm")});
  EXPECT_EQ(run_json({"check", path("o.vfm")})["sound"], true);
}

TEST_P(Models, TinyMeshesWorkOrSayWhyNot) {
  std::ofstream(path("one.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(run_json({"build", kind(), path("one.obj"), "-o", path("o.vfm")})["triangles"], 1);
  EXPECT_EQ(run_json({"check", path("o.vfm")})["sound"], true);
  EXPECT_EQ(run_json({"extract", path("o.vfm"), "--lod", "0", "-o", path("o.ply")})["triangles"],
            1);

  // All of its triangles are left out.
  std::ofstream(path("flat.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2\nf 3 3 3\n";
  const ToolResult flat =
      run_tool({"build", kind(), path("flat.obj"), "-o", path("f.vfm"), "--json"});
  if (flat.exit_code == 0) {
    EXPECT_EQ(flat.json()["triangles"], 0);
    EXPECT_EQ(flat.json()["dropped_degenerate_triangles"], 2);
    EXPECT_EQ(run_json({"check", path("f.vfm")})["sound"], true);
  } else {
    EXPECT_EQ(flat.exit_code, 3);
    EXPECT_EQ(lines_of(flat.err).size(), 1u) << flat.err;
  }
  std::ofstream(path("none.obj")) << "v 0 0 0\n";
  const ToolResult none = run_tool({"build", kind(), path("none.obj"), "-o", path("n.vfm")});
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_EQ(lines_of(none.err).size(), 1u) << none.err;
}

// Fronts: within the pixels, in the budget, closed, and coarser than the level that the same view
// asks for.
TEST_F(StripModels, ViewsTakeFrontsFromTheFramework) {
  make("strips", {});
  const std::vector<std::string> view = {"--eye", "1.6,0,0", "--target", "0,0,0", "--pixels", "2"};
  const auto extract = [&](const std::string& model, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"extract", path(model), "-o", path("front.ply"),
                                          "--json"};
    arguments.insert(arguments.end(), view.begin(), view.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ToolResult result = run_tool(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.json();
  };
  const json front = extract("m.vfm", {});
  EXPECT_FALSE(front.contains("level"));
  EXPECT_LE(front["pixel_error"].get<double>(), 2);
  EXPECT_GT(front["forced_splits"].get<int>(), 0);
  EXPECT_EQ(run_tool({"check", path("front.ply"), "--closed"}).exit_code, 0);
  const json budget = extract("m.vfm", {"--triangles", "500"});
  EXPECT_LE(budget["triangles"].get<int>(), 500);
  EXPECT_GT(budget["pixel_error"].get<double>(), 2);
  // The same view with a light asks for less; a ball on the far side for more.
  const json lit = extract("m.vfm", {"--light", "0,1,0"});
  EXPECT_LT(lit["triangles"].get<int>(), front["triangles"].get<int>());
  const json ball = extract("m.vfm", {"--sphere", "-1,0,0,0.3"});
  EXPECT_GT(ball["triangles"].get<int>(), front["triangles"].get<int>());
  const ToolResult side =
      run_tool({"extract", path("m.vfm"), "--plane", "1,0,0,0", "-o", path("side.ply"), "--json"});
  EXPECT_EQ(side.exit_code, 0) << side.err;
  EXPECT_GT(side.json()["triangles"].get<int>(), 2500);
  EXPECT_LT(side.json()["triangles"].get<int>(), 4500);
  EXPECT_EQ(run_tool({"check", path("side.ply"), "--closed"}).exit_code, 0);
  make("lodstrips", {});
  EXPECT_EQ(
      run_tool({"extract", path("m.vfm"), "--plane", "1,0,0,0", "-o", path("side.ply")}).exit_code,
      2);
  const json level = extract("m.vfm", {});
  EXPECT_GT(level["triangles"].get<int>(), front["triangles"].get<int>());
  EXPECT_EQ(level["forced_splits"], 0);
}

TEST_F(StripModels, FormsOfLodStrips) {
  const json blocks = make("lodstrips", {});
  const json grouped = make("lodstrips", {"--form", "grouped", "--stripifier", "cache"});
  const json thesis = make("lodstrips", {"--form", "thesis", "--stripifier", "sequence"});
  EXPECT_EQ(blocks["form"], "blocks");
  EXPECT_EQ(grouped["form"], "grouped");
  EXPECT_EQ(thesis["form"], "thesis");
  EXPECT_LT(blocks["model_bytes"].get<int>(), grouped["model_bytes"].get<int>());
  EXPECT_LT(grouped["model_bytes"].get<int>(), thesis["model_bytes"].get<int>());
  EXPECT_EQ(run_tool({"check", path("m.vfm")}).exit_code, 0);
  for (const std::vector<std::string>& wrong :
       std::vector<std::vector<std::string>>{{"--stripifier", "cache"}, {"--max-indices", "3"}}) {
    std::vector<std::string> arguments = {"build", "lodstrips", path("m.glb"), "-o", path("x.vfm")};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    EXPECT_EQ(run_tool(arguments).exit_code, 2);
  }
}

TEST_P(Models, CutAndDamagedModels) {
  (void)make_model("torus", "60");
  const std::string whole = bytes_of(path("m.vfm"));
  const std::size_t step = std::max<std::size_t>(1, whole.size() / 25);
  for (std::size_t place = 0; place < whole.size(); place += step) {
    std::ofstream(path("cut.vfm"), std::ios::binary) << whole.substr(0, place);
    expect_refused("cut.vfm");
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ (1 << place % 8));
    std::ofstream(path("damaged.vfm"), std::ios::binary) << damaged;
    expect_refused("damaged.vfm");
  }
}

// Right checksums around bytes that are those of another kind, or of none.
TEST_P(Models, BytesOfAnotherKind) {
  AllModels::for_each([&]<class Model>() {
    if (ModelKind<Model>::kName != kind()) return;
    for (const char* text : {"", "VPM1", "VMT1", "VLS1", "not a model"}) {
      const auto bytes = as_bytes(text);
      const Chunk chunk{ModelKind<Model>::kChunk, {bytes.begin(), bytes.end()}, false};
      const auto file = encode_container(ModelKind<Model>::kFourcc, std::span(&chunk, 1));
      ASSERT_TRUE(write_file(path("other.vfm"), *file));
      expect_refused("other.vfm");
    }
    const auto unknown = encode_container(fourcc("nope"), {});
    ASSERT_TRUE(write_file(path("unknown.vfm"), *unknown));
    expect_refused("unknown.vfm");
  });
}

std::vector<const char*> all_kinds() {
  std::vector<const char*> kinds;
  AllModels::for_each([&]<class Model>() { kinds.push_back(ModelKind<Model>::kName); });
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(Kinds, Models, ::testing::ValuesIn(all_kinds()),
                         [](const auto& kind) { return std::string(kind.param); });

TEST(BuildStrips, EveryStripifier) {
  const TemporaryFolder folder;
  const std::string mesh = folder.file("m.ply"), model = folder.file("m.vfm");
  ASSERT_EQ(run_tool({"generate", "knot", "--triangles", "3000", "-o", mesh}).exit_code, 0);
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
           {"length"}, {"cache"}, {"cache", "--cache-size", "24"}, {"sequence"}}) {
    std::vector<std::string> arguments{"build", "mts", mesh, "-o", model, "--stripifier"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    ASSERT_EQ(run_tool(arguments).exit_code, 0) << options[0];
    EXPECT_EQ(run_tool({"check", model}).exit_code, 0) << options[0];
  }
  EXPECT_EQ(run_tool({"build", "mts", mesh, "-o", model, "--cache-size", "20"}).exit_code, 2);
  EXPECT_EQ(run_tool({"build", "mts", mesh, "-o", model, "--stripifier", "nv"}).exit_code, 2);
}

}  // namespace
}  // namespace varifold
