// What extract tells of fronts, for every kind of model that has them.
#include <tests/cli/models_of_a_kind.h>

namespace varifold {
namespace {

using json = nlohmann::json;

class Fronts : public test::ModelsOfAKind {
 protected:
  [[nodiscard]] json extract(std::vector<std::string> view) const {
    const std::vector<std::string> command = {"extract", path("m.vfm"), "-o", path("front.ply")};
    view.insert(view.begin(), command.begin(), command.end());
    return run_json(view);
  }
};

TEST_P(Fronts, PixelErrorIsTheToleranceOfTheFront) {
  static_cast<void>(make_model("planet", "20000"));
  const std::vector<std::string> near = {"--eye", "1.6,0,0", "--target", "0,0,0", "--pixels", "2"};
  const json front = extract(near);
  EXPECT_FALSE(front.contains("level"));
  EXPECT_EQ(front["pixel_error"], 2);
  EXPECT_GT(front["forced_splits"].get<int>(), 0);
  EXPECT_LT(front["forced_splits"].get<int>(), front["vertices"].get<int>());
  EXPECT_EQ(test::run_tool({"check", path("front.ply"), "--closed"}).exit_code, 0);
  const json frame = extract({"--path", "orbit", "--frame", "7", "--pixels", "1.5"});
  EXPECT_EQ(frame["pixel_error"], 1.5);
  EXPECT_GT(frame["triangles"].get<int>(), 100);
  const json other = extract({"--path", "orbit", "--frame", "90", "--pixels", "1.5"});
  EXPECT_NE(frame["triangles"], other["triangles"]);
}

TEST_P(Fronts, ABudgetTellsTheToleranceAndTheForcedSplitsOfWhatItFound) {
  static_cast<void>(make_model("planet", "20000"));
  const std::vector<std::string> view = {"--eye", "1.6,0,0", "--target", "0,0,0"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), view.begin(), view.end());
    return extract(more);
  };
  const json budget = with({"--pixels", "0.5", "--triangles", "1500"});
  EXPECT_LE(budget["triangles"].get<int>(), 1500);
  EXPECT_GT(budget["triangles"].get<int>(), 1200);
  EXPECT_GT(budget["pixel_error"].get<double>(), 0.5);
  // The same front is the one of that tolerance.
  const json same = with({"--pixels", budget["pixel_error"].dump()});
  EXPECT_EQ(same["triangles"], budget["triangles"]);
  EXPECT_EQ(same["forced_splits"], budget["forced_splits"]);
}

// Strips take deviations as lengths in any case.
TEST_P(Fronts, DeviationsAreLengthsWhereThatIsAskedFor) {
  static_cast<void>(make_model("planet", "20000"));
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"--eye", "1.6,0,0", "--target", "0,0,0", "--pixels", "2"});
    return extract(more)["triangles"].get<int>();
  };
  const int as_ever = with({}), seen = with({"--deviation", "seen"});
  const int length = with({"--deviation", "length"});
  EXPECT_EQ(seen, as_ever);
  if (GetParam() == std::string("vdpm"))
    EXPECT_GT(length, seen);
  else
    EXPECT_EQ(length, seen);
  EXPECT_EQ(test::run_tool({"extract", path("m.vfm"), "-o", path("front.ply"), "--pixels", "2",
                            "--deviation", "other"})
                .exit_code,
            2);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Fronts, ::testing::Values("strips", "vdpm", "patchtree"),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace varifold
