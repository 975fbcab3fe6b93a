// Tests that run for every kind of model, through the tool.
#pragma once

#include <gtest/gtest.h>
#include <tests/cli/run_tool.h>
#include <tests/support/test_files.h>
#include <varifold/io/any_model.h>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace varifold::test {

class ModelsOfAKind : public ::testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  [[nodiscard]] static std::string kind() { return GetParam(); }

  [[nodiscard]] static nlohmann::json run_json(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const ToolResult result = run_tool(arguments);
    EXPECT_EQ(result.exit_code, 0) << ::testing::PrintToString(arguments) << result.err;
    return result.json();
  }
  [[nodiscard]] nlohmann::json make_model(const char* shape = "planet",
                                          const char* triangles = "3000") const {
    EXPECT_EQ(
        run_tool({"generate", shape, "--triangles", triangles, "-o", path("m.glb")}).exit_code, 0);
    std::vector<std::string> build{"build", kind(), path("m.glb"), "-o", path("m.vfm")};
    // Small meshes need small patches to have levels and fronts.
    if (kind() == "patchtree") build.insert(build.end(), {"--patch-triangles", "32"});
    return run_json(build);
  }
  TemporaryFolder folder_;
};

/// Their names, as the tool has them.
[[nodiscard]] inline std::vector<const char*> all_kinds() {
  std::vector<const char*> kinds;
  AllModels::for_each([&]<class Model>() { kinds.push_back(ModelKind<Model>::kName); });
  return kinds;
}

}  // namespace varifold::test
