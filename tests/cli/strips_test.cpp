// What the tool does with strips alone: their measures, their making, levels as strips.
#include <gtest/gtest.h>

#include <tests/cli/models_of_a_kind.h>
#include <tests/cli/run_tool.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/mesh/validation.h>
#include <algorithm>
#include <array>
#include <set>
#include <utility>

namespace varifold {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::lines_of;
using test::run_tool;
using test::TemporaryFolder;
using test::ToolResult;

// Corners as points, the least first, orientation kept.
using PointTriangle = std::array<std::array<float, 3>, 3>;
std::vector<PointTriangle> sorted_triangles(const TriangleMesh& mesh) {
  std::vector<PointTriangle> triangles;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    PointTriangle triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& p = mesh.positions[mesh.indices[i + c]];
      triangle[c] = {p.x, p.y, p.z};
    }
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                triangle.end());
    triangles.push_back(triangle);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

class Strips : public test::ModelsOfAKind {};

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

TEST_P(Strips, InfoMeasuresTheIndicesOfStrips) {
  const json told = make_model();
  const json info = run_json({"info", path("m.vfm")});
  const bool draws_strips = kind() != "pm" && kind() != "vdpm" && kind() != "patchtree";
  EXPECT_EQ(info.contains("index_samples"), draws_strips);
  if (!draws_strips) return;
  const json& samples = info["index_samples"];
  ASSERT_EQ(samples.size(), 5u);
  for (const json& sample : samples) {
    const double triangles = sample["triangles"];
    EXPECT_NEAR(sample["vertices"].get<double>(),
                info["vertices"].get<double>() * sample["percent"].get<int>() / 100, 2);
    EXPECT_DOUBLE_EQ(sample["indices_per_triangle"], sample["indices"].get<double>() / triangles);
    // A strip has two indices more than triangles, swaps among these, and a restart follows it.
    EXPECT_EQ(sample["indices"].get<std::int64_t>(),
              triangles + sample["swaps"].get<double>() + 3 * sample["strips"].get<double>() - 1);
    // Two or three indices in place of a restart.
    EXPECT_GE(sample["joined_indices"].get<std::int64_t>(),
              sample["indices"].get<std::int64_t>() + sample["strips"].get<std::int64_t>() - 1);
    EXPECT_LE(sample["joined_indices"].get<std::int64_t>(),
              sample["indices"].get<std::int64_t>() + 2 * sample["strips"].get<std::int64_t>() - 2);
    EXPECT_GE(sample["acmr_16"], sample["acmr_24"]);
    EXPECT_GE(sample["acmr_24"], sample["acmr_32"]);
    EXPECT_GT(sample["acmr_32"], 0.5);
    EXPECT_GE(sample["atvr_32"], 1);
    EXPECT_NEAR(sample["atvr_16"].get<double>() * sample["vertices"].get<double>(),
                sample["acmr_16"].get<double>() * triangles, 1e-6 * triangles);
  }
  // A build says the same of full detail.
  for (const char* key : {"strips", "indices", "indices_per_triangle", "swaps", "acmr_16",
                          "acmr_24", "acmr_32", "atvr_16", "joined_indices"})
    EXPECT_EQ(told[key], samples[0][key]) << key;
}

// As triangles, and as strips, which other programs read as the same triangles.
TEST_P(Strips, ExtractStrips) {
  for (const char* shape : {"planet", "seamed_sphere", "terrain", "box"}) {
    (void)make_model(shape);
    const std::size_t materials =
        std::max<std::size_t>(1, run_json({"info", path("m.vfm")})["materials"].size());
    const json list = run_json({"extract", path("m.vfm"), "--lod", "0.4", "-o", path("l.ply")});
    EXPECT_FALSE(list.contains("strips"));
    for (const auto& [how, file] :
         {std::pair{"restart", "s.ply"}, {"degenerate", "s.ply"}, {"degenerate", "s.glb"}}) {
      const json strips =
          run_json({"extract", path("m.vfm"), "--lod", "0.4", "--strips", how, "-o", path(file)});
      EXPECT_EQ(strips["triangles"], list["triangles"]) << shape;
      EXPECT_EQ(strips["vertices"], list["vertices"]) << shape;
      if (std::string(how) == "degenerate")
        EXPECT_EQ(strips["strips"], materials) << shape;
      else
        EXPECT_GT(strips["strips"], materials) << shape;
      EXPECT_GT(strips["indices_per_triangle"], 1.0);
      EXPECT_LT(strips["indices_per_triangle"], 3.5);
      const auto mesh = read_mesh(path(file));
      ASSERT_TRUE(mesh);
      EXPECT_TRUE(is_sound(validate(mesh->mesh))) << shape;
      EXPECT_EQ(sorted_triangles(mesh->mesh), sorted_triangles(read_mesh(path("l.ply"))->mesh))
          << shape << how << file;
    }
  }
  for (const auto& [how, file] : {std::pair{"restart", "s.glb"}, {"degenerate", "s.obj"}}) {
    std::filesystem::remove(path(file));
    EXPECT_EQ(run_tool({"extract", path("m.vfm"), "--lod", "1", "--strips", how, "-o", path(file)})
                  .exit_code,
              2);
    EXPECT_FALSE(std::filesystem::exists(path(file)));
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Strips, ::testing::ValuesIn(test::all_kinds()),
                         [](const auto& kind) { return std::string(kind.param); });

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

// Every rule makes other strips; sound ones.
TEST(BuildStrips, EveryHeuristic) {
  const TemporaryFolder folder;
  const std::string mesh = folder.file("m.ply"), model = folder.file("m.vfm");
  ASSERT_EQ(run_tool({"generate", "planet", "--triangles", "6000", "-o", mesh}).exit_code, 0);
  const auto build = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"build", "strips", mesh, "-o", model, "--json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_tool(arguments);
  };
  std::set<std::string> seen;
  std::vector<std::vector<std::string>> all{
      {}, {"--keep-ends"}, {"--heuristic", "random", "--strip-seed", "7"}};
  for (const char* rule : {"first", "random", "look-ahead", "alternate", "sequential", "straight"})
    all.push_back({"--heuristic", rule});
  for (const std::vector<std::string>& options : all) {
    const ToolResult result = build(options);
    ASSERT_EQ(result.exit_code, 0) << ::testing::PrintToString(options) << result.err;
    EXPECT_LT(result.json()["indices_per_triangle"], 1.7);
    EXPECT_TRUE(seen.insert(bytes_of(model)).second) << ::testing::PrintToString(options);
    EXPECT_EQ(run_tool({"check", model}).exit_code, 0) << ::testing::PrintToString(options);
  }
  const json rows = build({}).json();
  EXPECT_EQ(build({"--heuristic", "rows"}).json()["indices"], rows["indices"]);
  EXPECT_LT(rows["indices"], build({"--keep-ends"}).json()["indices"]);
  const json cache = build({"--stripifier", "cache"}).json();
  EXPECT_LT(cache["acmr_16"], rows["acmr_16"]);
  EXPECT_LT(build({"--stripifier", "cache", "--cache-size", "24"}).json()["acmr_24"],
            cache["acmr_24"]);
  for (const std::vector<std::string>& wrong :
       std::vector<std::vector<std::string>>{{"--heuristic", "luck"},
                                             {"--stripifier", "cache", "--heuristic", "first"},
                                             {"--stripifier", "sequence", "--keep-ends"},
                                             {"--strip-seed", "3"}}) {
    const ToolResult result = build(wrong);
    EXPECT_EQ(result.exit_code, 2) << ::testing::PrintToString(wrong);
    EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
  }
}

}  // namespace
}  // namespace varifold
