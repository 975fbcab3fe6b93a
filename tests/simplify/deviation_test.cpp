#include <varifold/simplify/deviation.h>

#include <gtest/gtest.h>
#include <tests/simplify/sequence_checks.h>
#include <tests/support/meshes.h>
#include <varifold/measure/closest_point.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/generators.h>
#include <algorithm>
#include <limits>

namespace varifold {
namespace {

// By definition: every vertex of the full mesh against every triangle of the level.
double farthest_vertex(const TriangleMesh& full, const TriangleMesh& level) {
  const SurfaceDistance surface(level);
  double farthest = 0;
  for (const Vec3& p : full.positions)
    farthest = std::max(farthest, static_cast<double>(surface.distance(p)));
  return farthest;
}

class Deviation : public testing::TestWithParam<Placement> {};

TEST_P(Deviation, BoundsTheDistanceOfEveryVertex) {
  SimplifyOptions options;
  options.placement = GetParam();
  std::vector<test::NamedMesh> meshes = test::group_closed();
  meshes.push_back({"planet", planet({{.triangles = 3000}})});
  meshes.push_back({"terrain", *generate("terrain", {.triangles = 2000})});
  for (const test::NamedMesh& named : meshes) {
    SCOPED_TRACE(named.name);
    const auto result = simplify(named.mesh, options);
    const CollapseSequence& sequence = result->detailed.sequence;
    EXPECT_TRUE(sequence.error_is_measured);
    const double diagonal = bounds(named.mesh).diagonal();
    double tightest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t level : test::spread_levels(sequence, 25)) {
      const double distance =
          farthest_vertex(result->detailed.mesh, mesh_at_level(result->detailed, level));
      ASSERT_LE(distance, sequence.error[level] * 1.0001 + 1e-6 * diagonal) << "level " << level;
      if (distance > 1e-3 * diagonal)
        tightest = std::min(tightest, sequence.error[level] / distance);
    }
    // It is a measurement and no rough bound: some level reaches it closely.
    if (tightest < std::numeric_limits<double>::infinity()) {
      EXPECT_LT(tightest, 1.2);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Placements, Deviation,
                         testing::Values(Placement::kKept, Placement::kOptimal));

TEST(Deviation, DoesNotDependOnThreads) {
  auto result = simplify(planet({{.triangles = 30000}}), {.measure_error = false});
  DetailedMesh one = result->detailed, two = result->detailed;
  EXPECT_FALSE(one.sequence.error_is_measured);
  ASSERT_TRUE(measure_deviation(one, {.threads = 1}));
  ASSERT_TRUE(measure_deviation(two, {.threads = 2}));
  EXPECT_EQ(one.sequence.error, two.sequence.error);
}

TEST(Deviation, CanBeCancelled) {
  auto result = simplify(planet({{.triangles = 30000}}), {.measure_error = false});
  EXPECT_FALSE(measure_deviation(result->detailed,
                                 {.progress = [](std::string_view, float) { return false; }}));
}

}  // namespace
}  // namespace varifold
