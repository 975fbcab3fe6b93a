#include <varifold/models/vdpm/watch_bounds.h>

#include <gtest/gtest.h>
#include <tests/models/vdpm/bounds_support.h>
#include <algorithm>
#include <cmath>

namespace varifold {
namespace {

using test::angle_between;
using test::angle_of;

// What the steps below in the tree ask for, entered into every one above, however far.
struct Exact {
  std::vector<double> radius, angle, error;
};
Exact exact_nesting(const std::vector<StepBounds>& bounds, const std::vector<Vec3>& centers,
                    const std::vector<std::uint32_t>& parent) {
  Exact exact;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    exact.radius.push_back(bounds[k].radius_length());
    exact.angle.push_back(angle_of(bounds[k].own_cone()));
    exact.error.push_back(std::max(bounds[k].mu_length(), bounds[k].delta_length()));
  }
  for (std::size_t k = 0; k < bounds.size(); ++k)
    for (std::uint32_t a = parent[k]; a != kNone; a = parent[a]) {
      const NormalCone own = bounds[k].own_cone();
      exact.radius[a] =
          std::max(exact.radius[a], glm::length(DVec3(centers[k]) - DVec3(centers[a])) +
                                        double{bounds[k].radius_length()});
      exact.angle[a] = std::max(exact.angle[a],
                                angle_between(own.axis, bounds[a].own_cone().axis) + angle_of(own));
      exact.error[a] = std::max(
          {exact.error[a], double{bounds[k].mu_length()}, double{bounds[k].delta_length()}});
    }
  return exact;
}

void expect_nested(const std::vector<StepBounds>& bounds, const Exact& exact, bool is_tight) {
  constexpr double kRight = 1.5707963267948966;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    SCOPED_TRACE("step " + std::to_string(k));
    ASSERT_LE(exact.radius[k], bounds[k].nested_radius_length());
    ASSERT_EQ(exact.error[k], bounds[k].nested_error_length());
    const bool is_wide = bounds[k].nested_angle == StepBounds::kWide;
    ASSERT_EQ(is_wide, bounds[k].nested_cone().is_wide());
    if (exact.angle[k] > kRight) {
      ASSERT_TRUE(is_wide);
    }
    if (!is_wide) {
      ASSERT_LE(exact.angle[k], angle_of(bounds[k].nested_cone()) + 1e-6);
      ASSERT_EQ(bounds[k].nested_cone().axis, bounds[k].own_cone().axis);
    }
    if (!is_tight) continue;
    ASSERT_LE(bounds[k].nested_radius_length(), exact.radius[k] * 1.01);
    if (exact.angle[k] < kRight - 0.003) {
      ASSERT_FALSE(is_wide);
      ASSERT_LE(angle_of(bounds[k].nested_cone()), exact.angle[k] + 0.003);
    }
  }
}

class WatchBounds : public testing::TestWithParam<Placement> {};
INSTANTIATE_TEST_SUITE_P(Placements, WatchBounds,
                         testing::Values(Placement::kKept, Placement::kOptimal));

TEST_P(WatchBounds, HoldThoseOfAllBelow) {
  for (const test::NamedSequence& named : test::sequences(GetParam(), 3000)) {
    SCOPED_TRACE(named.name);
    const DetailedMesh& detailed = named.detailed;
    const std::uint32_t steps = detailed.sequence.step_count();
    const auto watch = test::finest_required(detailed);
    std::vector<Vec3> centers;
    for (std::uint32_t k = 0; k < steps; ++k) {
      if (GetParam() == Placement::kKept) {
        centers.push_back(detailed.mesh.positions[detailed.sequence.vertices[k]]);
        continue;
      }
      TriangleMesh mesh = detailed.mesh;
      apply_placement(detailed.sequence, k + 1, mesh);
      centers.push_back(mesh.positions[detailed.sequence.vertices[k]]);
    }
    std::vector<StepBounds> bounds;
    ASSERT_TRUE(measure_step_bounds(detailed, watch, {}, bounds));
    expect_nested(bounds, exact_nesting(bounds, centers, watch), true);
    const auto other = test::random_parents(steps, 9);
    for (const std::uint32_t depth : {1u, 2u, 7u}) {
      nest_bounds(other, centers, bounds, depth);
      expect_nested(bounds, exact_nesting(bounds, centers, other), false);
    }
    nest_bounds(other, centers, bounds, steps + 1);
    expect_nested(bounds, exact_nesting(bounds, centers, other), true);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace varifold
