// Limits on splits and time, nodes that are not resident, criteria other than plain views, memory.
#include <tests/models/patch_tree/front_oracle.h>
#include <tests/support/count_allocations.h>

#include <gtest/gtest.h>

#include <varifold/mesh/generators.h>
#include <varifold/models/patch_tree/build.h>
#include <varifold/models/patch_tree/patch_draws.h>
#include <algorithm>

namespace varifold::test {
namespace {

RefineCriteria random_view(Random& random) {
  RefineCriteria criteria;
  criteria.view.emplace(random_camera(random));
  return criteria;
}

PatchFrontOptions options_of(float tolerance, std::uint32_t max_triangles = kNone) {
  PatchFrontOptions options;
  options.limits.tolerance = tolerance;
  options.limits.max_triangles = max_triangles;
  return options;
}

TEST(PatchFront, FromTheRootsDoesTheMostUrgentSplitsFirst) {
  for (const NamedTree& named : small_trees()) {
    SCOPED_TRACE(named.name);
    PatchFront front(named.tree);
    Random random(21);
    for (int frame = 0; frame < 15; ++frame) {
      const RefineCriteria criteria = random_view(random);
      PatchFrontOptions options = options_of(0.05f);
      options.max_splits = random.below(60);
      OracleStop stop;
      stop.tolerance = 0.05f;
      stop.splits = options.max_splits;
      const auto priorities = oracle_priorities(*named.tree, criteria, PatchMeasure::kPixels);
      const OracleFront oracle = oracle_front(*named.tree, priorities, stop);
      const PatchFrontResult result = front.adapt_split_only(criteria, options);
      ASSERT_EQ(flags_of(front), oracle.split);
      EXPECT_EQ(result.stop, oracle.is_stopped ? FrontStop::kSplits : FrontStop::kTolerance);
      EXPECT_EQ(result.statistics.waiting > 0, oracle.is_stopped);
      ASSERT_EQ(faults_of(front, priorities), "");
    }
  }
}

// However few splits a frame may do, still views come to the front that has no limits.
TEST(PatchFront, ComesToTheSameFrontInManyFrames) {
  for (const NamedTree& named : small_trees()) {
    SCOPED_TRACE(named.name);
    const auto tables = std::make_shared<const FrontTables>(named.tree);
    const std::uint32_t all =
        named.tree->data().offsets.empty() ? 0 : named.tree->data().offsets.back().triangle;
    PatchFront limited(tables), free(tables);
    Random random(23);
    for (int view = 0; view < 12; ++view) {
      const RefineCriteria criteria = random_view(random);
      PatchFrontOptions options = options_of(
          0.1f, view % 2 == 0 ? kNone : tables->root_triangles() + random.below(all + 1));
      free.adapt_split_only(criteria, options);
      // A chain of forced splits is done at once or not at all.
      options.max_splits = 12 + random.below(20);
      const auto priorities = oracle_priorities(*named.tree, criteria, PatchMeasure::kPixels);
      PatchFrontResult result;
      for (int frame = 0; frame < 200; ++frame) {
        result = limited.adapt(criteria, options);
        ASSERT_LE(result.statistics.splits, options.max_splits);
        ASSERT_LE(result.statistics.triangles, options.limits.max_triangles);
        ASSERT_EQ(faults_of(limited, priorities), "");
        if (result.stop != FrontStop::kSplits) break;
        EXPECT_GT(result.statistics.waiting, 0u);
      }
      ASSERT_NE(result.stop, FrontStop::kSplits);
      ASSERT_EQ(flags_of(limited), flags_of(free));
    }
  }
}

TEST(PatchFront, ATimeLimitLeavesAFrontThatIsWhole) {
  SyntheticOptions synthetic;
  const auto tree = std::make_shared<const PatchTree>(planet_tree(4000, synthetic));
  PatchFront front(tree);
  Random random(25);
  int stops = 0;
  for (int frame = 0; frame < 40; ++frame) {
    const RefineCriteria criteria = random_view(random);
    PatchFrontOptions options = options_of(0, frame % 2 == 0 ? kNone : 100000);
    options.max_microseconds = 5;
    const PatchFrontResult result =
        frame % 3 == 0 ? front.adapt_split_only(criteria, options) : front.adapt(criteria, options);
    stops += result.stop == FrontStop::kTime ? 1 : 0;
    if (result.stop == FrontStop::kTime) {
      EXPECT_GT(result.statistics.waiting, 0u);
    }
    ASSERT_LE(result.statistics.triangles, options.limits.max_triangles);
    if (frame % 8 < 2) {
      ASSERT_EQ(faults_of(front, oracle_priorities(*tree, criteria, PatchMeasure::kPixels)), "");
    }
  }
  EXPECT_GT(stops, 10);
}

struct Residents {
  std::vector<bool> flags;
  static bool are_resident(const void* context, std::uint32_t node) {
    return static_cast<const Residents*>(context)->flags[node];
  }
};

TEST(PatchFront, SplitsNothingThatRequiresANodeThatIsNotResident) {
  for (const NamedTree& named : small_trees()) {
    SCOPED_TRACE(named.name);
    const auto tables = std::make_shared<const FrontTables>(named.tree);
    PatchFront from_roots(tables), from_before(tables);
    Random random(27);
    Residents residents{std::vector<bool>(named.tree->node_count(), true)};
    const std::uint32_t all =
        named.tree->data().offsets.empty() ? 0 : named.tree->data().offsets.back().triangle;
    std::uint32_t refused = 0;
    for (int frame = 0; frame < 25; ++frame) {
      SCOPED_TRACE(frame);
      // Some come, some go.
      for (std::uint32_t node = 0; node < tables->inner_count(); ++node)
        if (random.below(6) == 0) residents.flags[node] = random.below(6) != 0;
      const RefineCriteria criteria = random_view(random);
      PatchFrontOptions options =
          options_of(0.02f, frame % 2 == 0 ? kNone : random.below(all + 10));
      const bool asks = frame % 5 != 4;
      if (asks) options.resident = {Residents::are_resident, &residents};
      OracleStop stop;
      stop.tolerance = options.limits.tolerance;
      if (options.limits.max_triangles != kNone) stop.triangles = options.limits.max_triangles;
      if (asks) stop.is_resident = [&](std::uint32_t node) { return residents.flags[node]; };
      const auto priorities = oracle_priorities(*named.tree, criteria, PatchMeasure::kPixels);
      const OracleFront oracle = oracle_front(*named.tree, priorities, stop);
      refused += from_roots.adapt_split_only(criteria, options).not_resident;
      from_before.adapt(criteria, options);
      ASSERT_EQ(flags_of(from_roots), oracle.split);
      ASSERT_EQ(flags_of(from_before), oracle.split);
      ASSERT_EQ(from_before.nodes().forced_count(), oracle.forced);
      ASSERT_EQ(from_roots.nodes().forced_count(), oracle.forced);
      ASSERT_EQ(faults_of(from_before, priorities), "");
    }
    if (tables->inner_count() > 20) {
      EXPECT_GT(refused, 0u);
    }
  }
}

struct OddPlaces final : RegionPredicate {
  [[nodiscard]] bool asks(const Sphere& ball, float error) const override {
    return error > 0.001f && ball.center.y + ball.radius > 0.6f;
  }
};

TEST(PatchFront, TakesAllCriteria) {
  const OddPlaces odd;
  const BoxCriterion boxes[] = {{{{0.2f, 0.2f, 0.2f}, {0.7f, 0.9f, 0.9f}}, 0.004f}};
  for (const NamedTree& named : small_trees()) {
    SCOPED_TRACE(named.name);
    const auto tables = std::make_shared<const FrontTables>(named.tree);
    PatchFront from_roots(tables), from_before(tables);
    Random random(29);
    for (int frame = 0; frame < 32; ++frame) {
      SCOPED_TRACE(frame);
      RefineCriteria criteria = random_view(random);
      if (frame % 8 == 1) criteria.view.reset();
      if (frame % 4 == 1) criteria.sphere = Sphere{{0, 0, 1}, 0.4f};
      if (frame % 4 == 2) criteria.plane = Plane{{1, 0, 0}, -0.8f};
      if (frame % 4 == 3) criteria.boxes = boxes;
      if (frame % 8 == 4) criteria.predicate = &odd;
      if (frame % 8 == 5) criteria.view->light = LightCriterion{};
      if (frame % 8 == 6) criteria.view->outside_weight = 0.3f;
      if (frame % 8 == 7) criteria.view->silhouette_weight = 2;
      const auto measure = frame % 5 == 0 ? PatchMeasure::kMeanSquared : PatchMeasure::kPixels;
      PatchFrontOptions options = options_of(0.5f, frame % 3 == 0 ? 2000 : kNone);
      options.measure = measure;
      const auto priorities = oracle_priorities(*named.tree, criteria, measure);
      OracleStop stop;
      stop.tolerance = 0.5f;
      if (options.limits.max_triangles != kNone) stop.triangles = 2000;
      const OracleFront oracle = oracle_front(*named.tree, priorities, stop);
      from_roots.adapt_split_only(criteria, options);
      from_before.adapt(criteria, options);
      ASSERT_EQ(flags_of(from_roots), oracle.split);
      ASSERT_EQ(flags_of(from_before), oracle.split);
    }
  }
}

TEST(PatchFront, AsksNothingOfViewsWithoutNumbers) {
  PatchFront front(small_trees()[7].tree);
  RefineCriteria criteria;
  Camera camera;
  camera.eye = Vec3(std::numeric_limits<float>::quiet_NaN());
  criteria.view.emplace(camera);
  front.adapt(criteria, options_of(0, 5000));
  EXPECT_EQ(front.nodes().split_count(), 0u);
  Random random(33);
  criteria = random_view(random);
  front.adapt(criteria, options_of(std::numeric_limits<float>::quiet_NaN(), 5000));
  EXPECT_EQ(front.nodes().split_count(), 0u);
}

TEST(PatchFront, AllocatesNothingOnceItIsWarm) {
  const auto tree = std::make_shared<const PatchTree>(planet_tree(2000, {}));
  PatchFront front(tree);
  std::vector<RefineCriteria> views;
  Random random(31);
  for (int i = 0; i < 30; ++i) views.push_back(random_view(random));
  for (int round = 0; round < 3; ++round) {
    const std::size_t before = allocations;
    for (const RefineCriteria& view : views) {
      for (const std::uint32_t budget : {kNone, 60000u, 9000u}) {
        front.adapt(view, options_of(0.3f, budget));
        front.adapt_split_only(view, options_of(0.3f, budget));
      }
      front.adapt(view, options_of(0.01f, 100000));
    }
    if (round > 0) {
      EXPECT_EQ(allocations - before, 0u);
    }
  }
}

TEST(PatchDraws, AllocateNothingOnceAFrontWasAsLarge) {
  PlanetOptions planet_options;
  planet_options.triangles = 6000;
  PatchTreeOptions tree_options;
  tree_options.triangles_per_patch = 40;
  auto built = build_patch_tree(planet(planet_options), tree_options);
  ASSERT_TRUE(built);
  const auto tree = std::make_shared<const PatchTree>(std::move(built->tree));
  PatchFront front(tree);
  PatchDraws draws(std::make_shared<const PatchDrawTables>(tree));
  std::vector<RefineCriteria> views;
  Random random(37);
  for (int i = 0; i < 30; ++i) views.push_back(random_view(random));
  for (int round = 0; round < 2; ++round) {
    const std::size_t before = allocations;
    for (const RefineCriteria& view : views) {
      front.adapt(view, options_of(0.3f));
      draws.follow(front.draws());
      ASSERT_EQ(draws.list().draws.size(), front.draws().draws().size());
    }
    if (round > 0) {
      EXPECT_EQ(allocations - before, 0u);
    }
  }
}

}  // namespace
}  // namespace varifold::test
