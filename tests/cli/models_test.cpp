// Every kind of model through every command that takes models; and bad models of every kind.
#include <gtest/gtest.h>

#include <tests/cli/models_of_a_kind.h>
#include <tests/cli/run_tool.h>
#include <tests/support/test_files.h>
#include <varifold/io/container.h>
#include <varifold/io/mesh_file.h>
#include <varifold/io/model_file.h>
#include <varifold/io/output_file.h>
#include <varifold/mesh/validation.h>
#include <algorithm>
#include <fstream>
#include <utility>
#include <vector>

namespace varifold {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::lines_of;
using test::run_tool;
using test::TemporaryFolder;
using test::ToolResult;

class Models : public test::ModelsOfAKind {
 protected:
  // Levels are those of a sequence of collapses; patch trees have a few levels of their own.
  [[nodiscard]] static bool has_sequence() { return kind() != "patchtree"; }
  [[nodiscard]] static bool follows_planes() { return kind() == "strips" || kind() == "patchtree"; }
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
};

TEST_P(Models, BuildHasTheKeysOfTheContract) {
  const json told = make_model();
  for (const char* key :
       {"kind", "vertices", "triangles", "seconds", "simplify_seconds", "peak_rss_bytes",
        "model_bytes", "file_bytes", "bytes_per_vertex", "levels", "error_is_measured"})
    EXPECT_TRUE(told.contains(key)) << key;
  EXPECT_EQ(told["kind"], kind());
  EXPECT_EQ(told["file_bytes"], std::filesystem::file_size(path("m.vfm")));
  if (kind() == "pm" || kind() == "vdpm" || kind() == "patchtree") return;
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
    EXPECT_GT(checked["levels_checked"], has_sequence() ? 10 : 1);

    const json level = run_json({"extract", path("m.vfm"), "--lod", "0.4", "-o", path("l.ply")});
    EXPECT_EQ(level["kind"], kind());
    const auto mesh = read_mesh(path("l.ply"));
    ASSERT_TRUE(mesh);
    EXPECT_TRUE(is_sound(validate(mesh->mesh))) << shape;
    EXPECT_EQ(mesh->mesh.triangle_count(), level["triangles"]);

    if (!has_sequence()) continue;
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
  if (has_sequence())
    EXPECT_EQ(drawn.json()["triangles"], 900);
  else
    EXPECT_LE(drawn.json()["triangles"], 900);
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

TEST_P(Models, SamplesAsManyAsAskedFor) {
  (void)make_model("torus", "200");
  for (const auto& [asked, told] : {std::pair{"2", 2u}, {"7", 7u}, {"101", 101u}, {"9000", 250u}}) {
    const json result = run_json({"bench", path("m.vfm"), "--steps", "250", "--samples", asked,
                                  "--draw", "none"})["results"][0];
    ASSERT_EQ(result["samples"].size(), told);
    EXPECT_EQ(result["samples"].front()["step"], 0);
    EXPECT_EQ(result["samples"].back()["step"], 249);
  }
  EXPECT_EQ(run_tool({"bench", path("m.vfm"), "--samples", "1"}).exit_code, 2);
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
  if (!follows_planes()) {
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
  EXPECT_GT(told["samples"][0]["triangles"], told["samples"][10]["triangles"]);
  EXPECT_GT(told["samples"][10]["triangles"], told["samples"][19]["triangles"]);
  // Every collapse on the way from full detail is one; forced splits may be collapsed later.
  EXPECT_GT(told["collapses"], run_json({"info", path("m.vfm")})["levels"].get<int>() / 2);
  EXPECT_GT(told["collapses_per_second"], 0);
}

// One model that the test is not for, and nothing is measured.
TEST_P(Models, AllModelsAreLookedAtBeforeThePlaneTest) {
  if (follows_planes()) return;
  (void)make_model("torus", "200");
  EXPECT_EQ(run_tool({"build", "strips", path("m.glb"), "-o", path("s.vfm")}).exit_code, 0);
  const ToolResult result = run_tool({"bench", path("s.vfm"), path("m.vfm"), "--test", "plane",
                                      "--steps", "10000000", "--draw", "none"},
                                     {.limit = std::chrono::milliseconds(20'000)});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_NE(result.err.find("m.vfm"), std::string::npos) << result.err;
}

TEST_P(Models, StripsRefuseOptimalPlacement) {
  (void)make_model("torus", "200");
  const ToolResult result =
      run_tool({"build", kind(), path("m.glb"), "--placement", "optimal", "-o", path("o.vfm")});
  EXPECT_EQ(result.exit_code, kind() == "pm" || kind() == "vdpm" ? 0 : 2) << result.err;
  EXPECT_EQ(std::filesystem::exists(path("o.vfm")), result.exit_code == 0);
}

TEST_P(Models, AreBuiltByEnergyToo) {
  if (!has_sequence()) GTEST_SKIP() << "not from a sequence";
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
  EXPECT_EQ(flat.exit_code, 3);
  EXPECT_EQ(lines_of(flat.err).size(), 1u) << flat.err;
  std::ofstream(path("none.obj")) << "v 0 0 0\n";
  const ToolResult none = run_tool({"build", kind(), path("none.obj"), "-o", path("n.vfm")});
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_EQ(lines_of(none.err).size(), 1u) << none.err;
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
    for (const char* text : {"", "VPM1", "VMT1", "VLS1", "VPT1", "not a model"}) {
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

INSTANTIATE_TEST_SUITE_P(Kinds, Models, ::testing::ValuesIn(test::all_kinds()),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace varifold
