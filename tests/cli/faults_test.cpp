// Wrong usage, bad input, outputs that cannot be written: exit codes and messages.
#include <gtest/gtest.h>

#include <tests/cli/run_tool.h>
#include <tests/support/test_files.h>
#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

namespace varifold {
namespace {

using test::bytes_of;
using test::lines_of;
using test::run_tool;
using test::TemporaryFolder;
using test::ToolOptions;
using test::ToolResult;

class Faults : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  void make_model(const char* triangles) const {
    ASSERT_EQ(
        run_tool({"generate", "torus", "--triangles", triangles, "-o", path("m.ply")}).exit_code,
        0);
    ASSERT_EQ(run_tool({"build", "pm", path("m.ply"), "-o", path("m.vfm")}).exit_code, 0);
  }
  [[nodiscard]] std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.file("")))
      names.insert(entry.path().filename());
    return names;
  }

  TemporaryFolder folder_;
};

/// Exit code 3 and one line that names the file.
void expect_bad_input(const ToolResult& result, const std::filesystem::path& file) {
  EXPECT_EQ(result.exit_code, 3) << file << ": " << result.err;
  const auto lines = lines_of(result.err);
  ASSERT_EQ(lines.size(), 1u) << file << ": " << result.err;
  EXPECT_NE(lines[0].find(file.filename().string()), std::string::npos) << lines[0];
}

TEST_F(Faults, WrongUsage) {
  make_model("500");
  const std::string mesh = path("m.ply"), model = path("m.vfm"), out = path("o.ply");
  const std::vector<std::vector<std::string>> all{
      {},
      {"explode"},
      {"build", "patchwork", mesh, "-o", out},
      {"generate", "pyramid", "-o", out},
      {"generate", "planet"},
      {"generate", "planet", "--triangles", "0", "-o", out},
      {"generate", "planet", "--triangles", "-5", "-o", out},
      {"generate", "torus", "--relief", "1", "-o", out},
      {"generate", "knot", "--p", "2", "--q", "4", "-o", out},
      {"generate", "planet", "-o", path("o.stl")},
      {"info"},
      {"info", mesh, "--threads", "0"},
      {"simplify", mesh, "-o", out},
      {"simplify", mesh, "--triangles", "5", "--ratio", "0.5", "-o", out},
      {"simplify", mesh, "--ratio", "1.5", "-o", out},
      {"simplify", mesh, "--ratio", "0.5", "--ignore", "edges", "-o", out},
      {"build", "pm", mesh, "--position-bits", "99", "-o", out},
      {"build", "pm", mesh, "--json", "-o", "-"},
      {"extract", model, "-o", out},
      {"extract", model, "--lod", "2", "-o", out},
      {"extract", model, "--lod", "0.5", "--error", "1", "-o", out},
      {"extract", model, "--pixels", "1", "--eye", "1,2", "-o", out},
      {"extract", model, "--pixels", "1", "--eye", "0,0,1", "--target", "0,0,1", "-o", out},
      {"extract", model, "--pixels", "1", "--size", "0x5", "-o", out},
      {"check", model, "--against", mesh},
      {"render", mesh, "--triangles", "5", "-o", path("o.png")},
      {"info", mesh, "--colour"}};
  for (const auto& arguments : all) {
    const ToolResult result = run_tool(arguments);
    const std::string line = ::testing::PrintToString(arguments);
    EXPECT_EQ(result.exit_code, 2) << line << result.err;
    EXPECT_EQ(lines_of(result.err).size(), 1u) << line << result.err;
    const bool wants_json =
        std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
    EXPECT_EQ(result.out.empty(), !wants_json) << line;
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

// Exit code 2, one line that has `word` in it, and nothing written.
void expect_wrong_usage(const std::vector<std::string>& arguments, const std::string& word) {
  const ToolResult result = run_tool(arguments);
  const std::string line = ::testing::PrintToString(arguments) + result.err;
  EXPECT_EQ(result.exit_code, 2) << line;
  EXPECT_EQ(lines_of(result.err).size(), 1u) << line;
  EXPECT_NE(result.err.find(word), std::string::npos) << line;
}

TEST_F(Faults, NumbersThatAreNone) {
  make_model("500");
  const std::string mesh = path("m.ply"), model = path("m.vfm"), out = path("o.ply");
  const std::string picture = path("o.png");
  for (const char* number : {"nan", "NaN", "-nan", "inf", "infinity", "1e999", "1e60"}) {
    for (const char* option : {"--lod", "--error", "--pixels"}) {
      expect_wrong_usage({"extract", model, option, number, "-o", out}, option);
      expect_wrong_usage({"render", model, option, number, "-o", picture}, option);
    }
    for (const char* option : {"--fovy", "--azimuth", "--elevation", "--wire-width"})
      expect_wrong_usage({"render", mesh, option, number, "-o", picture}, option);
    for (const char* option : {"--ratio", "--error"})
      expect_wrong_usage({"simplify", mesh, option, number, "-o", out}, option);
    for (const char* option : {"--weld", "--normal-weight"})
      expect_wrong_usage({"build", "pm", mesh, option, number, "-o", path("o.vfm")}, option);
    expect_wrong_usage({"generate", "planet", "--relief", number, "-o", out}, "--relief");
  }
  expect_wrong_usage({"extract", model, "--lod", "half", "-o", out}, "--lod");
  EXPECT_EQ(files(), (std::set<std::string>{"m.ply", "m.vfm"}));
}

TEST_F(Faults, LessThanTheBaseIsTheBaseWithAWarning) {
  make_model("500");
  for (const char* option : {"--vertices", "--triangles"}) {
    const ToolResult result =
        run_tool({"extract", path("m.vfm"), option, "0", "-o", path("o.ply"), "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.json()["level"], 0);
    ASSERT_EQ(lines_of(result.err).size(), 1u) << result.err;
    EXPECT_NE(result.err.find(std::string("warning: the base has ")), std::string::npos);
    EXPECT_NE(result.err.find(option + 2), std::string::npos) << result.err;
    const std::string base = result.json()[option + 2].dump();
    const ToolResult enough =
        run_tool({"extract", path("m.vfm"), option, base, "-o", path("o.ply")});
    EXPECT_EQ(enough.err, "") << base;
  }
}

// Before any work: the input need not even be there.
TEST_F(Faults, NamesOfOtherFormats) {
  expect_wrong_usage({"render", path("none.ply"), "-o", path("x.jpg")}, ".png");
  for (const char* kind : {"pm", "strips", "vdpm", "lodstrips", "mts"})
    expect_wrong_usage({"build", kind, path("none.ply"), "-o", path("x.ply")}, ".vfm");
  EXPECT_EQ(run_tool({"generate", "torus", "--triangles", "60", "-o", path("m.ply")}).exit_code, 0);
  EXPECT_EQ(run_tool({"build", "pm", path("m.ply"), "-o", path("M.VFM")}).exit_code, 0);
  EXPECT_EQ(run_tool({"build", "pm", path("m.ply"), "-o", path("model")}).exit_code, 0);
  EXPECT_EQ(run_tool({"info", path("model")}).exit_code, 0);
  EXPECT_EQ(files(), (std::set<std::string>{"m.ply", "M.VFM", "model"}));
}

TEST_F(Faults, BuildNamesItsKinds) {
  for (const char* word : {"patchwork", "pm", "strips", "lodstrips", "mts"})
    expect_wrong_usage({"build", "patchwork", path("m.ply"), "-o", path("o.vfm")}, word);
  expect_wrong_usage({"build"}, "lodstrips");
  expect_wrong_usage({"build", "pm"}, "mesh is required");
}

TEST_F(Faults, MeshesOfDegenerateTrianglesAlone) {
  std::ofstream(path("flat.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2\nf 3 3 3\n";
  for (const char* kind : {"pm", "strips", "lodstrips", "mts"}) {
    const ToolResult result = run_tool({"build", kind, path("flat.obj"), "-o", path("o.vfm")});
    expect_bad_input(result, "flat.obj");
    EXPECT_NE(result.err.find("degenerate"), std::string::npos) << result.err;
  }
  expect_bad_input(run_tool({"simplify", path("flat.obj"), "--ratio", "0.5", "-o", path("o.ply")}),
                   "flat.obj");
  EXPECT_EQ(files(), std::set<std::string>{"flat.obj"});
}

TEST_F(Faults, StripifierOptionsWithoutUse) {
  make_model("60");
  const std::string mesh = path("m.ply"), out = path("o.vfm");
  for (const char* kind : {"strips", "mts"}) {
    expect_wrong_usage(
        {"build", kind, mesh, "--stripifier", "sequence", "--max-indices", "20", "-o", out},
        "--max-indices");
    expect_wrong_usage({"build", kind, mesh, "--cache-size", "16", "-o", out}, "--cache-size");
  }
  expect_wrong_usage({"build", "lodstrips", mesh, "--form", "thesis", "--stripifier", "sequence",
                      "--max-indices", "64", "-o", out},
                     "--max-indices");
  expect_wrong_usage({"build", "lodstrips", mesh, "--max-indices", "64", "-o", out}, "--form");
  EXPECT_EQ(files(), (std::set<std::string>{"m.ply", "m.vfm"}));
}

TEST_F(Faults, FrontsAreOfModelsThatHaveThem) {
  make_model("60");
  expect_wrong_usage({"check", path("m.ply"), "--fronts", "5"}, "--fronts");
  expect_wrong_usage({"check", path("m.vfm"), "--fronts", "5"}, "strips");
  EXPECT_FALSE(run_tool({"check", path("m.vfm"), "--json"}).json().contains("fronts_checked"));
}

TEST_F(Faults, HelpIsNoFault) {
  EXPECT_EQ(run_tool({"--help"}).exit_code, 0);
  EXPECT_EQ(run_tool({"--version"}).exit_code, 0);
  for (const char* command :
       {"generate", "info", "simplify", "build", "extract", "check", "render", "demo"})
    EXPECT_NE(run_tool({command, "--help"}).out.find("--help"), std::string::npos) << command;
}

TEST_F(Faults, MissingFiles) {
  const std::string missing = path("missing.ply"), model = path("missing.vfm");
  const std::string out = path("o.ply");
  expect_bad_input(run_tool({"info", missing}), missing);
  expect_bad_input(run_tool({"check", missing}), missing);
  expect_bad_input(run_tool({"simplify", missing, "--ratio", "0.5", "-o", out}), missing);
  expect_bad_input(run_tool({"build", "pm", missing, "-o", path("o.vfm")}), missing);
  expect_bad_input(run_tool({"extract", model, "--lod", "1", "-o", out}), model);
  expect_bad_input(run_tool({"check", model}), model);
  expect_bad_input(run_tool({"render", model, "-o", path("o.png")}), model);
  expect_bad_input(run_tool({"info", folder_.file("")}), "");
  EXPECT_TRUE(files().empty());
}

TEST_F(Faults, FailuresAreJsonToo) {
  const ToolResult result = run_tool({"info", path("missing.ply"), "--json"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.json()["exit_code"], 3);
  EXPECT_EQ(run_tool({"explode", "--json"}).json()["exit_code"], 2);
}

TEST_F(Faults, AMeshWithoutTriangles) {
  std::ofstream(path("points.obj")) << "v 0 0 0\nv 1 0 0\n";
  EXPECT_EQ(run_tool({"info", path("points.obj")}).exit_code, 0);
  expect_bad_input(run_tool({"build", "pm", path("points.obj"), "-o", path("o.vfm")}),
                   "points.obj");
}

TEST_F(Faults, NonfinitePositions) {
  std::ofstream(path("nan.obj")) << "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n";
  expect_bad_input(run_tool({"build", "pm", path("nan.obj"), "-o", path("o.vfm")}), "nan.obj");
}

TEST_F(Faults, EveryBadFileGivesASoundMeshOrAnError) {
  VARIFOLD_REAL_MESH_OR_SKIP(bad, "bad");
  ToolOptions limit;
  limit.limit = std::chrono::milliseconds(10'000);
  const auto expect_tame = [](const ToolResult& result, const std::filesystem::path& file) {
    if (result.exit_code == 0) return true;
    expect_bad_input(result, file);
    return false;
  };
  int read = 0, built = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(bad)) {
    if (!entry.is_regular_file()) continue;
    const std::string file = entry.path();
    if (expect_tame(run_tool({"info", file, "--json"}, limit), file)) ++read;
    if (!expect_tame(run_tool({"build", "pm", file, "-o", path("o.vfm")}, limit), file)) continue;
    ++built;
    const ToolResult checked = run_tool({"check", path("o.vfm"), "--json"}, limit);
    EXPECT_EQ(checked.exit_code, 0) << file << checked.out << checked.err;
  }
  EXPECT_GT(read, 20);
  EXPECT_GT(built, 20);
}

TEST_F(Faults, TruncatedModels) {
  make_model("60");
  const std::string whole = bytes_of(path("m.vfm"));
  const std::size_t step = std::max<std::size_t>(1, whole.size() / 150);
  for (std::size_t size = 0; size < whole.size(); size += step) {
    std::ofstream(path("cut.vfm"), std::ios::binary) << whole.substr(0, size);
    expect_bad_input(run_tool({"extract", path("cut.vfm"), "--lod", "1", "-o", path("o.ply")}),
                     "cut.vfm");
  }
  EXPECT_FALSE(std::filesystem::exists(path("o.ply")));
}

TEST_F(Faults, DamagedModels) {
  make_model("60");
  const std::string whole = bytes_of(path("m.vfm"));
  const std::size_t step = std::max<std::size_t>(1, whole.size() / 150);
  for (std::size_t place = 0; place < whole.size(); place += step) {
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ (1 << place % 8));
    std::ofstream(path("damaged.vfm"), std::ios::binary) << damaged;
    expect_bad_input(run_tool({"info", path("damaged.vfm")}), "damaged.vfm");
  }
}

TEST_F(Faults, OutputsThatCannotBeWritten) {
  make_model("500");
  const auto before = files();
  const std::string mesh = path("m.ply"), model = path("m.vfm");
  const std::string nowhere = path("no_folder");
  const std::vector<std::vector<std::string>> all{
      {"build", "pm", mesh, "-o", "/dev/full"},
      {"render", mesh, "--size", "64x64", "-o", "/dev/full"},
      {"build", "pm", mesh, "-o", nowhere + "/m.vfm"},
      {"extract", model, "--lod", "1", "-o", nowhere + "/m.obj"},
      {"simplify", mesh, "--ratio", "0.5", "-o", nowhere + "/m.glb"},
      {"generate", "torus", "-o", nowhere + "/m.glb"},
      {"demo", "-o", mesh + "/demo"}};
  for (const auto& arguments : all) {
    const ToolResult result = run_tool(arguments);
    EXPECT_EQ(result.exit_code, 1) << ::testing::PrintToString(arguments) << result.err;
    EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
  }
  // A full device behind the name of a mesh.
  std::filesystem::create_symlink("/dev/full", path("full.ply"));
  EXPECT_EQ(run_tool({"extract", model, "--lod", "1", "-o", path("full.ply")}).exit_code, 1);
  std::filesystem::remove(path("full.ply"));
  EXPECT_EQ(files(), before);
}

TEST_F(Faults, InterruptedJobsLeaveNothing) {
  ASSERT_EQ(
      run_tool({"generate", "planet", "--triangles", "2000000", "-o", path("m.ply")}).exit_code, 0);
  ToolOptions interrupt;
  interrupt.interrupt_after_ms = 300;
  const ToolResult result =
      run_tool({"build", "pm", path("m.ply"), "-o", path("m.vfm")}, interrupt);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.err.find("cancelled"), std::string::npos) << result.err;
  EXPECT_EQ(files(), std::set<std::string>{"m.ply"});
}

}  // namespace
}  // namespace varifold
