// `varifold check` on files whose fronts are not what they should be.
#include <gtest/gtest.h>

#include <tests/cli/run_tool.h>
#include <tests/support/test_files.h>
#include <varifold/io/model_file.h>
#include <set>

namespace varifold {
namespace {

using nlohmann::json;
using test::run_tool;
using test::TemporaryFolder;
using test::ToolResult;

// Those dependencies alone that the reader insists on: a step waits for those that go to its
// vertices.
std::vector<std::uint32_t> thinned_dependencies(const StripFramework& model) {
  const std::uint32_t steps = model.finest_level();
  std::vector<std::uint32_t> words;
  std::vector<std::uint32_t> step_of(model.vertex_count(0), kNone);
  for (std::uint32_t k = 0; k < steps; ++k)
    step_of.insert(step_of.end(), model.levels().step(k).vertices, k);
  std::vector<std::set<std::uint32_t>> coming(steps);
  for (std::uint32_t v = model.vertex_count(0); v < step_of.size(); ++v)
    if (const std::uint32_t to = step_of[model.levels().target(v)]; to != kNone)
      coming[to].insert(step_of[v]);
  for (std::uint32_t k = steps; k-- > 0;) {
    words.insert(words.end(), coming[k].begin(), coming[k].end());
    if (coming[k].empty())
      words.push_back(kNone);
    else
      words.back() |= StripFrameworkData::kLastDependency;
  }
  return words;
}

// Checksums are right, and so are all levels; fronts are not.
TEST(CheckFrontsTool, FindsThinnedDependencies) {
  const TemporaryFolder folder;
  const auto path = [&](const std::string& name) { return folder.file(name); };
  ASSERT_EQ(run_tool({"generate", "planet", "--triangles", "6000", "-o", path("m.ply")}).exit_code,
            0);
  ASSERT_EQ(run_tool({"build", "strips", path("m.ply"), "-o", path("m.vfm")}).exit_code, 0);
  const json sound = run_tool({"check", path("m.vfm"), "--fronts", "40", "--json"}).json();
  EXPECT_EQ(sound["sound"], true) << sound;
  EXPECT_EQ(sound["fronts_checked"], 40);
  const auto any = read_any_model(path("m.vfm"));
  ASSERT_TRUE(any);
  const StripFramework& model = *std::get<std::shared_ptr<const StripFramework>>(*any);
  StripFrameworkData data = model.data();
  const std::vector<std::uint32_t> words = thinned_dependencies(model);
  EXPECT_LT(words.size(), data.dependencies.size());
  data.dependencies = words;
  ASSERT_TRUE(write_model(StripFramework(std::move(data), model.full_strips()), path("thin.vfm")));
  EXPECT_EQ(run_tool({"info", path("thin.vfm")}).exit_code, 0);
  const ToolResult result = run_tool({"check", path("thin.vfm"), "--json"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(result.json()["sound"], false);
  std::set<std::string> kinds;
  const json told = result.json();
  for (const json& fault : told["faults"]) kinds.insert(fault["kind"]);
  EXPECT_EQ(kinds.count("missing_dependency"), 1u) << result.out;
  EXPECT_EQ(kinds.count("front_flipped_triangle"), 1u) << result.out;
}

}  // namespace
}  // namespace varifold
