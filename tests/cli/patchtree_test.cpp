// What the tool does with patch trees beyond other kinds of models.
#include <gtest/gtest.h>

#include <tests/cli/run_tool.h>
#include <tests/support/test_files.h>
#include <varifold/io/model_file.h>
#include <varifold/render/image_difference.h>
#include <varifold/render/png.h>
#include <map>
#include <set>
#include <span>

namespace varifold {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::run_tool;
using test::ToolResult;

class PatchTreeTool : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  [[nodiscard]] static json run_json(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const ToolResult result = run_tool(arguments);
    EXPECT_EQ(result.exit_code, 0) << ::testing::PrintToString(arguments) << result.err;
    return result.json();
  }
  [[nodiscard]] json make(const std::vector<std::string>& more = {}) const {
    EXPECT_EQ(
        run_tool({"generate", "planet", "--triangles", "20000", "-o", path("m.ply")}).exit_code, 0);
    std::vector<std::string> arguments{"build",   "patchtree", path("m.ply"), "--ignore",
                                       "normals", "-o",        path("m.vfm")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_json(arguments);
  }
  [[nodiscard]] json extract(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"extract", path("m.vfm"), "-o", path("front.ply")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_json(arguments);
  }
  test::TemporaryFolder folder_;
};

TEST_F(PatchTreeTool, BuildTellsOfTheTree) {
  const json told = make({"--patch-triangles", "128"});
  EXPECT_EQ(told["triangles"], 20480);
  EXPECT_EQ(told["stop_reason"], "one_root");
  EXPECT_EQ(told["roots"], 1);
  EXPECT_GT(told["nodes"], 250);
  EXPECT_LE(told["stored_ratio"], 2.05);
  EXPECT_LT(told["file_bytes_per_triangle"], 30);
  EXPECT_EQ(told["error_is_measured"], true);
  for (const char* const key :
       {"read_seconds", "partition_seconds", "simplify_seconds", "measure_seconds",
        "layout_seconds", "model_seconds", "write_seconds", "triangles_per_second"})
    EXPECT_GT(told[key], 0) << key;
  // Fewer patches of more triangles.
  EXPECT_LT(make({"--patch-triangles", "1000"})["nodes"], told["nodes"].get<int>() / 5);
  for (const char* const wrong : {"0", "4001", "x"})
    EXPECT_EQ(run_tool({"build", "patchtree", path("m.ply"), "--patch-triangles", wrong, "-o",
                        path("w.vfm")})
                  .exit_code,
              2);
}

// A patch is where the head says, in the file itself.
TEST_F(PatchTreeTool, OffsetsAreThoseOfTheFile) {
  (void)make({"--patch-triangles", "128"});
  const json chunk = run_json({"info", path("m.vfm")})["chunks"][0];
  EXPECT_EQ(chunk["compressed"], false);
  EXPECT_EQ(chunk["file_bytes"], chunk["raw_bytes"]);
  EXPECT_NE(bytes_of(path("m.vfm")).find("VPT1"), std::string::npos);
}

TEST_F(PatchTreeTool, ExtractFrontsThatAreClosed) {
  (void)make({"--patch-triangles", "64"});
  const std::vector<std::string> view{"--eye", "1.6,0,0", "--target", "0,0,0"};
  std::uint64_t collapsed = 0;
  for (const std::vector<std::string>& level : std::vector<std::vector<std::string>>{
           {"--pixels", "2"}, {"--pixels", "0.5", "--triangles", "3000"}, {"--triangles", "900"}}) {
    std::vector<std::string> arguments = view;
    arguments.insert(arguments.end(), level.begin(), level.end());
    const json front = extract(arguments);
    EXPECT_FALSE(front.contains("level"));
    collapsed += front["collapsed_triangles"].get<std::uint64_t>();
    const std::uint64_t stored =
        front["triangles"].get<std::uint64_t>() + front["collapsed_triangles"].get<std::uint64_t>();
    if (level.back() == "3000") {
      EXPECT_LE(stored, 3000u);
      EXPECT_GT(stored, 2700u);
    }
    EXPECT_EQ(run_tool({"check", path("front.ply"), "--closed"}).exit_code, 0);
  }
  EXPECT_GT(collapsed, 0u);
  const json sphere = extract({"--sphere", "1,0,0,0.2"});
  EXPECT_EQ(run_tool({"check", path("front.ply"), "--closed"}).exit_code, 0);
  EXPECT_LT(sphere["triangles"], 12000);
  EXPECT_EQ(extract({"--lod", "1"})["triangles"], 20480);
}

TEST_F(PatchTreeTool, TrianglesWithoutAViewMixLevels) {
  (void)make({"--patch-triangles", "64"});
  bool is_mixed = false;
  for (const int budget : {2000, 3500, 6000, 12000, 20479}) {
    const json front = extract({"--triangles", std::to_string(budget)});
    EXPECT_FALSE(front.contains("level"));
    EXPECT_EQ(front["over_budget"], false);
    const int stored = front["triangles"].get<int>() + front["collapsed_triangles"].get<int>();
    EXPECT_LE(stored, budget);
    EXPECT_GT(stored, 0.9 * budget);
    is_mixed |= front["collapsed_triangles"] > 0;
    EXPECT_EQ(run_tool({"check", path("front.ply"), "--closed"}).exit_code, 0);
    const json rendered = run_json({"render", path("m.vfm"), "--triangles", std::to_string(budget),
                                    "--size", "64x64", "-o", path("m.png")});
    EXPECT_EQ(rendered["triangles"], stored);
    EXPECT_EQ(rendered["error"], front["error"]);
    // The finest whole level of no more.
    json level;
    for (int k = 0; k < 12; ++k) {
      const json next = extract({"--level", std::to_string(k)});
      EXPECT_EQ(next["level"], k);
      if (next["triangles"] > budget) break;
      level = next;
      if (next["level"] == next["finest_level"]) break;
    }
    EXPECT_LT(front["error"], level["error"]);
  }
  EXPECT_TRUE(is_mixed);
  // All of it is the finest level, nothing are the roots.
  const json all = extract({"--triangles", "20480"});
  EXPECT_EQ(all["level"], all["finest_level"]);
  EXPECT_EQ(all["error"], 0);
  const ToolResult none =
      run_tool({"extract", path("m.vfm"), "--triangles", "1", "-o", path("front.ply"), "--json"});
  EXPECT_EQ(none.exit_code, 0);
  EXPECT_NE(none.err.find("nothing coarser"), std::string::npos) << none.err;
  EXPECT_EQ(none.json()["over_budget"], true);
  EXPECT_EQ(none.json()["triangles"], extract({"--level", "0"})["triangles"]);
  EXPECT_EQ(none.json()["error"], extract({"--level", "0"})["error"]);
  // No such level, and two levels.
  EXPECT_EQ(run_tool({"extract", path("m.vfm"), "--level", "99", "-o", path("f.ply")}).exit_code,
            2);
  EXPECT_EQ(run_tool({"extract", path("m.vfm"), "--level", "1", "--triangles", "500", "-o",
                      path("f.ply")})
                .exit_code,
            2);
}

TEST_F(PatchTreeTool, CheckLooksAtFronts) {
  (void)make({"--patch-triangles", "64"});
  const json sound = run_json({"check", path("m.vfm"), "--fronts", "40"});
  EXPECT_EQ(sound["sound"], true) << sound;
  EXPECT_EQ(sound["fronts_checked"], 40);
  EXPECT_GT(sound["collapsed_triangles"], 0);

  // The bit of another neighbour: checksums are right, and so are all levels.
  const auto any = read_any_model(path("m.vfm"));
  ASSERT_TRUE(any);
  PatchTreeData data = std::get<std::shared_ptr<const PatchTree>>(*any)->data();
  for (std::uint32_t node = data.topology.first_of_level[1]; node < data.bounds.size(); ++node) {
    if (data.topology.neighbors_of(data.topology.parent[node]).size() < 2) continue;
    for (std::uint32_t i = data.offsets[node].controller; i < data.offsets[node + 1].controller;
         ++i)
      data.controllers[i] = data.controllers[i] == 0 ? 1 : 0;
  }
  ASSERT_TRUE(write_model(PatchTree(std::move(data)), path("bad.vfm")));
  const ToolResult result = run_tool({"check", path("bad.vfm"), "--fronts", "40", "--json"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  std::set<std::string> kinds;
  const json told = result.json();
  for (const json& fault : told["faults"]) kinds.insert(fault["kind"]);
  EXPECT_EQ(kinds.count("wrong_controller"), 1u) << result.out;
  EXPECT_EQ(kinds.count("front_open_edge"), 1u) << result.out;
}

TEST_F(PatchTreeTool, BenchComparesWithFrontsFromTheRoots) {
  (void)make({"--patch-triangles", "64"});
  const json told = run_json({"bench", path("m.vfm"), "--test", "camera", "--path", "orbit",
                              "--triangles", "5000", "--per-frame"})["results"][0];
  EXPECT_GT(told["patches_mean"], 10);
  EXPECT_GT(told["from_roots_ms_p50"], 0);
  EXPECT_LE(told["triangles_max"], 5000);
  for (const json& frame : told["per_frame"]) {
    EXPECT_GT(frame["patches"], 0);
    EXPECT_LE(frame["triangles"], 5000);
  }
}

TEST_F(PatchTreeTool, ThePapersPriority) {
  (void)make({"--patch-triangles", "64"});
  const auto bench = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"bench",  path("m.vfm"), "--test",
                                       "camera", "--path",      "dive"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  const json pixels = run_json(bench({"--triangles", "5000"}))["results"][0];
  const json paper = run_json(bench({"--triangles", "5000", "--paper-priority"}))["results"][0];
  EXPECT_NE(pixels["frames_checksum"], paper["frames_checksum"]);
  EXPECT_LE(paper["triangles_max"], 5000);
  EXPECT_EQ(run_tool(bench({"--paper-priority"})).exit_code, 2);
  // Along the surface counts, too, by mean values.
  (void)make({"--patch-triangles", "64", "--priority", "mean-value"});
  const json mean = run_json(bench({"--triangles", "5000", "--paper-priority"}))["results"][0];
  EXPECT_NE(mean["frames_checksum"], paper["frames_checksum"]);
}

TEST_F(PatchTreeTool, RenderShowsPatchesAndCracks) {
  (void)make({"--patch-triangles", "64"});
  const auto render = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", path("m.vfm"),     "-o",       path("m.png"),
                                       "--size", "200x150",         "--sphere", "1,0,0,0.3",
                                       "--json", "--supersampling", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  };
  const ToolResult plain = render({});
  if (plain.exit_code == 1 && plain.err.find("EGL") != std::string::npos)
    GTEST_SKIP() << "no OpenGL here: " << plain.err;
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_GT(plain.json()["collapsed_triangles"], 0);
  std::set<std::string> pictures{bytes_of(path("m.png"))};
  for (const std::vector<std::string>& how : std::vector<std::vector<std::string>>{
           {"--color", "patch"}, {"--color", "level"}, {"--no-border-switch"}}) {
    const ToolResult drawn = render(how);
    ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
    EXPECT_EQ(drawn.json()["patches"], plain.json()["patches"]);
    EXPECT_EQ(drawn.json()["collapsed_triangles"] == 0, how[0] == "--no-border-switch");
    pictures.insert(bytes_of(path("m.png")));
  }
  EXPECT_EQ(pictures.size(), 4u);
  EXPECT_EQ(run_tool({"render", path("m.ply"), "--color", "patch", "-o", path("m.png")}).exit_code,
            2);
  EXPECT_EQ(
      run_tool({"render", path("m.ply"), "--no-border-switch", "-o", path("m.png")}).exit_code, 2);
}

Image8 picture_in(const std::string& path) {
  const std::string bytes = bytes_of(path);
  auto image = read_png(std::as_bytes(std::span(bytes)));
  EXPECT_TRUE(image) << path;
  return image ? std::move(*image) : Image8{};
}

// Commands over constant indices against index arrays, in which borders are written anew.
TEST_F(PatchTreeTool, RenderLooksTheSameInBothForms) {
  (void)make({"--patch-triangles", "64"});
  const auto render = [&](const std::vector<std::string>& how, const std::string& name) {
    std::vector<std::string> arguments{"render",          path("m.vfm"), "-o",       path(name),
                                       "--size",          "320x240",     "--sphere", "1,0,0,0.3",
                                       "--supersampling", "1",           "--json"};
    arguments.insert(arguments.end(), how.begin(), how.end());
    return run_tool(arguments);
  };
  if (const ToolResult plain = render({}, "a.png");
      plain.exit_code == 1 && plain.err.find("EGL") != std::string::npos)
    GTEST_SKIP() << "no OpenGL here: " << plain.err;
  const Image8 plain = picture_in(path("a.png"));
  for (const std::vector<std::string>& how :
       std::vector<std::vector<std::string>>{{},
                                             {"--color", "patch"},
                                             {"--color", "level"},
                                             {"--color", "strip"},
                                             {"--color", "material"},
                                             {"--wireframe"},
                                             {"--flat", "--cull"},
                                             {"--no-border-switch"}}) {
    SCOPED_TRACE(::testing::PrintToString(how));
    const ToolResult commands = render(how, "commands.png");
    std::vector<std::string> arrays_of = how;
    arrays_of.emplace_back("--arrays");
    const ToolResult arrays = render(arrays_of, "arrays.png");
    ASSERT_EQ(commands.exit_code, 0) << commands.err;
    ASSERT_EQ(arrays.exit_code, 0) << arrays.err;
    for (const char* const key : {"patches", "triangles", "collapsed_triangles", "pixel_error"})
      EXPECT_EQ(commands.json()[key], arrays.json()[key]) << key;
    const Image8 drawn = picture_in(path("commands.png"));
    const auto same = image_difference(drawn, picture_in(path("arrays.png")), 6);
    ASSERT_TRUE(same);
    EXPECT_LE(same->part_above, 2e-4);
    const auto other = image_difference(drawn, plain, 6);
    ASSERT_TRUE(other);
    if (how.size() < 2) {
      EXPECT_EQ(other->max > 6, !how.empty());
    }
  }
  EXPECT_EQ(run_tool({"render", path("m.ply"), "--arrays", "-o", path("m.png")}).exit_code, 2);
}

TEST_F(PatchTreeTool, BenchDrawsBothForms) {
  (void)make({"--patch-triangles", "64"});
  std::map<std::string, json> told;
  for (const char* const how : {"none", "multi", "indirect"}) {
    const ToolResult result =
        run_tool({"bench", path("m.vfm"), "--test", "camera", "--path", "dive", "--pixels", "1",
                  "--size", "400x300", "--per-frame", "--draw", how, "--json"});
    if (result.exit_code == 1 && result.err.find("EGL") != std::string::npos)
      GTEST_SKIP() << "no OpenGL here: " << result.err;
    ASSERT_EQ(result.exit_code, 0) << result.err;
    told[how] = result.json()["results"][0];
    EXPECT_EQ(told[how]["draw"], how);
    EXPECT_EQ(told[how]["frames_checksum"], told["none"]["frames_checksum"]);
  }
  EXPECT_TRUE(told["none"]["uploaded_bytes_mean"].is_null());
  EXPECT_GT(told["indirect"]["uploaded_bytes_mean"], 0);
  EXPECT_GT(told["indirect"]["upload_ms_p50"], 0);
  // The arrays leave out what the switches collapse.
  EXPECT_GE(told["indirect"]["indices_submitted"], told["multi"]["indices_submitted"]);
  bool is_first = true;
  for (const json& frame : told["indirect"]["per_frame"]) {
    // 40 bytes a command; runs that are near each other are joined.
    EXPECT_EQ(frame["changed_bytes"].get<int>() % 40, 0);
    EXPECT_EQ(frame["uploaded_bytes"].get<int>() % 40, 0);
    if (!is_first) {
      EXPECT_GE(frame["uploaded_bytes"], frame["changed_bytes"]);
    }
    is_first = false;
    EXPECT_EQ(frame["indices_submitted"], 3 * frame["triangles"].get<int>());
  }
  // One walk through the levels, too; by default with commands.
  for (const auto& [how, expected] : std::map<std::string, std::string>{
           {"auto", "indirect"}, {"multi", "multi"}, {"strips", "strips"}}) {
    const json walk =
        run_json({"bench", path("m.vfm"), "--steps", "20", "--draw", how})["results"][0];
    EXPECT_EQ(walk["draw"], expected);
    // Nothing is switched in whole levels, so that the arrays stay as they are.
    EXPECT_EQ(walk["uploaded_bytes_mean"] > 0, expected == "indirect");
  }
  EXPECT_EQ(run_tool({"generate", "planet", "--triangles", "500", "-o", path("p.ply")}).exit_code,
            0);
  EXPECT_EQ(run_tool({"build", "pm", path("p.ply"), "-o", path("p.vfm")}).exit_code, 0);
  EXPECT_EQ(run_tool({"bench", path("p.vfm"), "--draw", "indirect"}).exit_code, 2);
}

TEST_F(PatchTreeTool, RenderBlendsBetweenLevels) {
  (void)make({"--patch-triangles", "64"});
  const auto render = [&](const std::vector<std::string>& how) {
    std::vector<std::string> arguments{"render",  path("m.vfm"),     "-o", path("m.png"), "--size",
                                       "200x150", "--supersampling", "1",  "--json"};
    arguments.insert(arguments.end(), how.begin(), how.end());
    return run_tool(arguments);
  };
  const ToolResult plain = render({"--pixels", "2"});
  if (plain.exit_code == 1 && plain.err.find("EGL") != std::string::npos)
    GTEST_SKIP() << "no OpenGL here: " << plain.err;
  const Image8 without = picture_in(path("m.png"));
  EXPECT_FALSE(plain.json().contains("moving_vertices"));
  int moving = 0;
  for (const std::vector<std::string>& band :
       std::vector<std::vector<std::string>>{{}, {"--morph-band", "2"}}) {
    std::vector<std::string> arguments{"--pixels", "2", "--morph"};
    arguments.insert(arguments.end(), band.begin(), band.end());
    const ToolResult blended = render(arguments);
    ASSERT_EQ(blended.exit_code, 0) << blended.err;
    const json told = blended.json();
    EXPECT_EQ(told["triangles"], plain.json()["triangles"]) << "the same front";
    EXPECT_GT(told["moving_vertices"], moving);
    moving = told["moving_vertices"];
    EXPECT_LT(told["turned_triangles"], 0.05 * told["triangles"].get<double>());
    const auto other = image_difference(picture_in(path("m.png")), without, 6);
    ASSERT_TRUE(other);
    EXPECT_GT(other->part_above, 0.005);
  }
  EXPECT_EQ(render({"--triangles", "3000", "--eye", "2,0,0", "--morph"}).exit_code, 0);
  // Nothing says where a vertex is on its way, or it cannot be drawn.
  for (const std::vector<std::string>& wrong :
       std::vector<std::vector<std::string>>{{"--morph"},
                                             {"--triangles", "3000", "--morph"},
                                             {"--pixels", "2", "--morph-band", "2"},
                                             {"--pixels", "2", "--morph", "--morph-band", "1"},
                                             {"--pixels", "2", "--morph", "--arrays"},
                                             {"--pixels", "2", "--morph", "--sphere", "1,0,0,0.2"}})
    EXPECT_EQ(render(wrong).exit_code, 2) << ::testing::PrintToString(wrong);
  EXPECT_EQ(run_tool({"render", path("m.ply"), "--morph", "--pixels", "1", "-o", path("m.png")})
                .exit_code,
            2);
}

TEST_F(PatchTreeTool, BenchTellsOfJumpsAndTurnedTriangles) {
  (void)make({"--patch-triangles", "64"});
  const auto bench = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"bench",  path("m.vfm"), "--test",   "camera",
                                       "--path", "dive",        "--pixels", "2",
                                       "--size", "800x600",     "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  };
  const json plain = bench({}).json()["results"][0];
  const json blended = bench({"--morph-band", "2", "--per-frame"}).json()["results"][0];
  EXPECT_EQ(plain["frames_checksum"], blended["frames_checksum"]);
  EXPECT_TRUE(plain["morph_band"].is_null());
  EXPECT_EQ(plain["moving_vertices_part"], 0);
  EXPECT_EQ(plain["turned_per_million_triangles"], 0);
  EXPECT_GT(plain["max_jump_pixels"], 5);
  EXPECT_GT(plain["max_surface_jump_pixels"], 1);
  // Most frames change nothing; blended ones change a little.
  EXPECT_EQ(plain["jump_pixels_p50"], 0);
  EXPECT_GT(blended["jump_pixels_p50"], 0);
  EXPECT_LT(blended["max_jump_pixels"], plain["max_jump_pixels"].get<double>() / 2);
  EXPECT_EQ(blended["morph_band"], 2);
  EXPECT_GT(blended["moving_vertices_part"], 0.1);
  EXPECT_GT(blended["turned_per_million_triangles"], 0);
  double turned = 0, triangles = 0;
  for (const json& frame : blended["per_frame"]) {
    turned += frame["turned_triangles"].get<double>();
    triangles += frame["triangles"].get<double>();
    EXPECT_LE(frame["turned_seen"], frame["turned_triangles"]);
  }
  EXPECT_NEAR(blended["turned_per_million_triangles"], 1e6 * turned / triangles, 1e-3);
  EXPECT_EQ(bench({"--morph-band", "2", "--draw", "multi"}).exit_code, 2);
  EXPECT_EQ(bench({"--morph-band", "1"}).exit_code, 2);
  EXPECT_EQ(run_tool({"bench", path("m.vfm"), "--morph-band", "2"}).exit_code, 2);
}

}  // namespace
}  // namespace varifold
