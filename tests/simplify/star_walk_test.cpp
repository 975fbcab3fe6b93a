// Walking along a history is the same as doing the collapses.
#include <gtest/gtest.h>
#include <tests/support/meshes.h>

#include <varifold/simplify/simplify.h>
#include <varifold/simplify/star_walk.h>
#include <algorithm>

namespace varifold::test {
namespace {

TEST(StarWalk, GivesTheListsOfAReplayInTheSameOrder) {
  std::size_t removed = 0, changed = 0, around = 0;
  for (const auto& group : all_groups()) {
    const auto result = simplify(group.mesh, {.measure_error = false});
    if (!result) continue;
    const DetailedMesh& detailed = result->detailed;
    const SequenceHistory history(detailed);
    StarWalk replay(detailed, nullptr), walk(detailed, &history);
    std::vector<std::uint32_t> expected, found;
    const auto check = [&](const auto& ask) {
      expected.clear();
      found.clear();
      ask(replay, expected);
      ask(walk, found);
      ASSERT_EQ(found, expected) << group.name << ", level " << walk.level();
    };
    while (replay.level() > 0) {
      check([](StarWalk& w, auto& slots) { w.removed_slots(slots); });
      removed += found.size();
      replay.collapse();
      walk.collapse();
      ASSERT_EQ(walk.level(), replay.level());
      ASSERT_TRUE(std::ranges::equal(walk.changed(), replay.changed())) << group.name;
      changed += walk.changed().size();
      const std::uint32_t vertices = detailed.sequence.vertices[walk.level()];
      for (std::uint32_t v = walk.level() % 7; v < vertices; v += 7) {
        check([&](StarWalk& w, auto& slots) { w.slots_of(v, slots); });
        around += found.size();
      }
    }
    EXPECT_EQ(walk.corners(), replay.corners()) << group.name;
  }
  EXPECT_GT(removed, changed);
  EXPECT_GT(changed, 1000u);
  EXPECT_GT(around, 1000u);
}

}  // namespace
}  // namespace varifold::test
