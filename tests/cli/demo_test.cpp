// The demo, with and without OpenGL.
#include <gtest/gtest.h>

#include <tests/cli/run_tool.h>
#include <tests/support/test_files.h>
#include <cstdlib>

namespace varifold {
namespace {

TEST(Demo, MakesAPageWithPictures) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("demo");
  const auto result = test::run_tool({"demo", "-o", out, "--triangles", "20000", "--json"},
                                     {.input = {}, .limit = std::chrono::minutes(5)});
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
}

}  // namespace
}  // namespace varifold
