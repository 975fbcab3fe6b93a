// Fronts by a tolerance or a budget, from the roots and from the front before, against brute force.
#include <tests/models/patch_tree/front_oracle.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace varifold::test {
namespace {

struct Question {
  RefineCriteria criteria;
  PatchFrontOptions options;
};

// A view with random weights; a tolerance or a budget that stops somewhere.
Question random_question(const PatchTree& tree, Random& random) {
  Question question;
  question.criteria.view.emplace(random_camera(random));
  question.criteria.view->outside_weight = random.below(3) == 0 ? 1 : 0;
  question.criteria.view->back_weight = random.below(3) == 0 ? 0 : 1;
  const bool squares = random.below(4) == 0;
  question.options.measure = squares ? PatchMeasure::kMeanSquared : PatchMeasure::kPixels;
  const double power = squares ? -8 + 8 * random.uniform() : -2 + 4 * random.uniform();
  question.options.limits.tolerance =
      random.below(8) == 0 ? 0 : static_cast<float>(std::pow(10, power));
  if (random.below(2) == 0) {
    question.options.limits.tolerance *= 0.1f;
    const std::uint32_t all = tree.data().offsets.empty() ? 0 : tree.data().offsets.back().triangle;
    question.options.limits.max_triangles = random.below(all / 2 + 10);
  }
  return question;
}

OracleStop stop_of(const PatchFrontOptions& options) {
  OracleStop stop;
  stop.tolerance = options.limits.tolerance;
  if (options.limits.max_triangles != kNone) stop.triangles = options.limits.max_triangles;
  return stop;
}

void expect_front(const PatchFront& front, const PatchFrontResult& result,
                  const OracleFront& oracle, const Question& question) {
  ASSERT_EQ(flags_of(front), oracle.split);
  EXPECT_EQ(result.statistics.forced_splits, oracle.forced);
  EXPECT_EQ(result.statistics.triangles, front.draws().triangles());
  EXPECT_EQ(result.stop, oracle.is_stopped ? FrontStop::kTriangles : FrontStop::kTolerance);
  EXPECT_EQ(result.statistics.tolerance,
            oracle.is_stopped ? oracle.stopped_at : question.options.limits.tolerance);
  EXPECT_EQ(result.is_over_budget,
            result.statistics.triangles > question.options.limits.max_triangles);
  if (result.is_over_budget) {
    EXPECT_EQ(result.statistics.triangles, front.tables().root_triangles());
  }
}

TEST(PatchFront, IsThatOfBruteForceFromTheRootsAndFromAnyFrontBefore) {
  for (const NamedTree& named : small_trees()) {
    SCOPED_TRACE(named.name);
    const auto tables = std::make_shared<const FrontTables>(named.tree);
    PatchFront from_roots(tables), from_before(tables), in_turns(tables);
    Random random(11);
    std::uint32_t splits = 0;
    for (int frame = 0; frame < 40; ++frame) {
      SCOPED_TRACE(frame);
      const Question question = random_question(*named.tree, random);
      const auto priorities =
          oracle_priorities(*named.tree, question.criteria, question.options.measure);
      const OracleFront oracle = oracle_front(*named.tree, priorities, stop_of(question.options));
      expect_front(from_roots, from_roots.adapt_split_only(question.criteria, question.options),
                   oracle, question);
      expect_front(from_before, from_before.adapt(question.criteria, question.options), oracle,
                   question);
      expect_front(in_turns,
                   random.below(2) == 0
                       ? in_turns.adapt(question.criteria, question.options)
                       : in_turns.adapt_split_only(question.criteria, question.options),
                   oracle, question);
      if (HasFatalFailure()) return;
      for (const PatchFront* front : {&from_roots, &from_before, &in_turns})
        ASSERT_EQ(faults_of(*front, priorities), "");
      if (question.options.limits.max_triangles == kNone) {
        ASSERT_EQ(oracle.split,
                  oracle_threshold(*named.tree, priorities, question.options.limits.tolerance));
      }
      splits += from_before.nodes().split_count();
    }
    if (tables->inner_count() > 0) {
      EXPECT_GT(splits, 0u);
    }
  }
}

TEST(PatchFront, FollowsSmoothPathsLikeTheOneFromTheRoots) {
  SyntheticOptions options;
  options.error = 1e-4f;
  const PatchTree trees[] = {planet_tree(1500, options), torus_tree(5, 6, options)};
  for (const PatchTree& tree : trees) {
    const auto tables =
        std::make_shared<const FrontTables>(std::make_shared<const PatchTree>(tree));
    for (const std::uint32_t budget : {kNone, 100000u, 40000u, 9000u}) {
      SCOPED_TRACE(budget);
      PatchFront from_roots(tables), from_before(tables);
      PatchFrontOptions front_options;
      front_options.limits.tolerance = budget == kNone ? 0.7f : 0.01f;
      front_options.limits.max_triangles = budget;
      std::uint32_t changes = 0, stops = 0;
      for (int frame = 0; frame < 120; ++frame) {
        Camera camera;
        const float angle = 0.0175f * static_cast<float>(frame);
        camera.eye =
            (1.7f + 0.4f * std::sin(3 * angle)) * Vec3(std::cos(angle), 0.3f, std::sin(angle));
        camera.up = {0, 1, 0};
        camera.near_distance = 0.01f;
        RefineCriteria criteria;
        criteria.view.emplace(camera);
        from_roots.adapt_split_only(criteria, front_options);
        const PatchFrontResult result = from_before.adapt(criteria, front_options);
        ASSERT_EQ(flags_of(from_roots), flags_of(from_before)) << frame;
        ASSERT_EQ(sorted_draws(from_roots), sorted_draws(from_before)) << frame;
        ASSERT_LE(result.statistics.triangles, budget);
        if (result.stop == FrontStop::kTriangles) {
          ASSERT_GT(result.statistics.triangles, budget - budget / 3);
        }
        stops += result.stop == FrontStop::kTriangles ? 1 : 0;
        if (frame > 0) changes += result.statistics.splits + result.statistics.collapses;
      }
      EXPECT_GT(changes, 20u);
      if (budget < 50000) {
        EXPECT_GT(stops, 60u);
      }
    }
  }
}

TEST(PatchFront, NeighboursDifferByAtMostOneLevel) {
  for (const NamedTree& named : small_trees()) {
    SCOPED_TRACE(named.name);
    const PatchTopology& t = named.tree->topology();
    PatchFront front(named.tree);
    Random random(3);
    for (int frame = 0; frame < 20; ++frame) {
      const Question question = random_question(*named.tree, random);
      front.adapt(question.criteria, question.options);
      // The level of the front at each leaf.
      std::vector<std::uint32_t> level_at(t.node_count(), kNone);
      for (const PatchDraw& draw : front.draws().draws())
        for (std::uint32_t level = 0; level < t.level_count(); ++level)
          if (draw.node >= t.first_of_level[level]) level_at[draw.node] = level;
      for (std::uint32_t node = 0; node < t.node_count(); ++node) {
        const std::uint32_t parent = t.parent[node];
        if (parent == kNone || level_at[parent] == kNone) continue;
        ASSERT_EQ(level_at[node], kNone) << "covered twice";
        level_at[node] = level_at[parent];
      }
      for (std::uint32_t node = front.tables().inner_count(); node < t.node_count(); ++node) {
        ASSERT_NE(level_at[node], kNone);
        for (const std::uint32_t neighbor : t.neighbors_of(node))
          ASSERT_LE(level_at[node], level_at[neighbor] + 1);
      }
    }
  }
}

TEST(PatchFront, NamesTheDrawsThatChange) {
  for (const NamedTree& named : small_trees()) {
    SCOPED_TRACE(named.name);
    PatchFront front(named.tree);
    Random random(5);
    std::vector<PatchDraw> before(front.draws().draws().begin(), front.draws().draws().end());
    for (int frame = 0; frame < 60; ++frame) {
      const Question question = random_question(*named.tree, random);
      if (random.below(3) == 0)
        front.adapt_split_only(question.criteria, question.options);
      else
        front.adapt(question.criteria, question.options);
      const auto now = front.draws().draws();
      std::vector<std::uint32_t> expected;
      for (std::uint32_t slot = 0; slot < now.size(); ++slot)
        if (slot >= before.size() || !(before[slot] == now[slot])) expected.push_back(slot);
      std::vector<std::uint32_t> changed(front.draws().changed_slots().begin(),
                                         front.draws().changed_slots().end());
      std::sort(changed.begin(), changed.end());
      ASSERT_EQ(changed, expected) << frame;
      before.assign(now.begin(), now.end());
    }
  }
}

TEST(PatchFront, LooksAtNothingWhereNothingMoved) {
  PatchFront front(small_trees()[7].tree);
  RefineCriteria criteria;
  Random random(9);
  criteria.view.emplace(random_camera(random));
  PatchFrontOptions options;
  options.limits.tolerance = 0.01f;
  options.limits.max_triangles = 9000;
  const PatchFrontResult first = front.adapt(criteria, options);
  EXPECT_GT(first.statistics.splits, 3u);
  EXPECT_FALSE(front.draws().changed_slots().empty());
  const PatchFrontResult second = front.adapt(criteria, options);
  EXPECT_EQ(second.statistics.splits + second.statistics.collapses, 0u);
  EXPECT_EQ(second.statistics.triangles, first.statistics.triangles);
  EXPECT_EQ(second.stop, first.stop);
  EXPECT_TRUE(front.draws().changed_slots().empty());
}

}  // namespace
}  // namespace varifold::test
