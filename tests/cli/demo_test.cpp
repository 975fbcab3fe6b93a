// The demo, with and without OpenGL.
#include <gtest/gtest.h>

#include <tests/cli/run_tool.h>
#include <tests/support/test_files.h>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace varifold {
namespace {

test::ToolResult run_demo(const std::string& folder) {
  return test::run_tool({"demo", "-o", folder, "--triangles", "20000", "--json"},
                        {.input = {}, .limit = std::chrono::minutes(5)});
}

// What the page says of the forms: static strips are best at full detail and get worse, those of
// blocks stay, and none is as short as strips that are made for the level.
void expect_strips(const nlohmann::json& strips, const std::string& folder) {
  ASSERT_EQ(strips["forms"].size(), 3u) << strips;
  ASSERT_EQ(strips["levels"].size(), 5u) << strips;
  for (const auto& form : strips["forms"]) {
    EXPECT_EQ(form["sound"], true) << form;
    EXPECT_TRUE(std::filesystem::exists(folder + "/" + form["file"].get<std::string>()));
  }
  EXPECT_EQ(strips["levels"][0]["triangles"], strips["triangles"]);
  double grouped_before = 1, triangles_before = 1e9;
  for (const auto& level : strips["levels"]) {
    const auto& indices = level["indices_per_triangle"];
    const double blocks = indices["blocks"], grouped = indices["grouped"], fresh = indices["fresh"];
    EXPECT_LT(level["triangles"], triangles_before) << level;
    EXPECT_GT(fresh, 1) << level;
    EXPECT_LT(fresh, std::min(blocks, grouped)) << level;
    EXPECT_LT(blocks, 1.85) << level;
    EXPECT_GT(grouped, grouped_before) << level;
    EXPECT_EQ(indices["thesis"], indices["grouped"]) << level;
    EXPECT_EQ(blocks < grouped, level["share"] < 0.4) << level;
    grouped_before = grouped;
    triangles_before = level["triangles"];
  }
}

// The commands that the demo shows make what it made.
void expect_reproduced(const nlohmann::json& strips, const std::string& folder) {
  const std::string mesh = folder + "/again.ply", model = folder + "/again.vfm";
  ASSERT_EQ(test::run_tool({"generate", "planet", "--triangles", "40000", "-o", mesh}).exit_code,
            0);
  for (std::size_t i = 0; i < strips["forms"].size(); ++i) {
    const auto& form = strips["forms"][i];
    const std::string name = form["name"];
    const auto built =
        test::run_tool({"build", "lodstrips", "--form", name, mesh, "-o", model, "--json"});
    ASSERT_EQ(built.exit_code, 0) << built.err;
    EXPECT_EQ(test::bytes_of(model), test::bytes_of(folder + "/" + form["file"].get<std::string>()))
        << name;
    EXPECT_DOUBLE_EQ(built.json()["indices_per_triangle"],
                     strips["levels"][0]["indices_per_triangle"][name].get<double>());
    EXPECT_DOUBLE_EQ(built.json()["bytes_per_vertex"], form["bytes_per_vertex"].get<double>());
  }
}

void expect_strip_pictures(const nlohmann::json& strips, const std::string& folder, bool drawn) {
  std::size_t pictures = 0;
  for (const auto& level : strips["levels"]) {
    const std::string picture = level["picture"];
    if (picture.empty()) continue;
    ++pictures;
    EXPECT_TRUE(std::filesystem::exists(folder + "/" + picture)) << picture;
  }
  EXPECT_EQ(pictures, drawn ? 3u : 0u);
}

TEST(Demo, MakesAPageWithPictures) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("demo");
  const auto result = run_demo(out);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto told = result.json();
  EXPECT_EQ(told["sound"], true) << told;
  EXPECT_GE(told["models"].size(), 3u);
  EXPECT_EQ(told["models"][0]["levels"].size(), 5u);
  for (const auto& level : told["models"][0]["levels"])
    EXPECT_TRUE(std::filesystem::exists(out + "/" + level["mesh"].get<std::string>()));
  const std::string page = test::bytes_of(out + "/index.html");
  EXPECT_NE(page.find("</html>"), std::string::npos);
  if (told["device"] != "") {
    EXPECT_NE(page.find("data:image/png;base64,iVBOR"), std::string::npos);
  }
  expect_strips(told["strips"], out);
  expect_strip_pictures(told["strips"], out, told["device"] != "");
  expect_reproduced(told["strips"], out);
}

TEST(Demo, HasItsTablesWithoutOpenGl) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("demo");
  // EGL then finds no driver.
  ASSERT_EQ(setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent", 1), 0);
  const auto result = run_demo(out);
  unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto told = result.json();
  if (told["device"] != "") GTEST_SKIP() << "this EGL has its drivers elsewhere";
  expect_strips(told["strips"], out);
  expect_strip_pictures(told["strips"], out, false);
  const std::string page = test::bytes_of(out + "/index.html");
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_NE(page.find("<th>indices a triangle</th><th>blocks</th>"), std::string::npos);
}

}  // namespace
}  // namespace varifold
