// The dependencies of steps.
#include <gtest/gtest.h>

#include <varifold/mesh/generators.h>
#include <varifold/models/common/step_graph.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>

namespace varifold {
namespace {

TEST(StepGraph, DoesNotDependOnThreads) {
  for (const Placement placement : {Placement::kKept, Placement::kOptimal}) {
    const auto result =
        simplify(planet({{.triangles = 60000}}), {.placement = placement, .measure_error = false});
    const DetailedMesh& detailed = result->detailed;
    const SequenceHistory history(detailed);
    const StepGraph one(detailed, history, 1);
    ASSERT_GT(one.step_count(), 20000u);  // several blocks
    ASSERT_GT(one.edge_count(), one.step_count());
    for (const int threads : {2, 3}) {
      const StepGraph other(detailed, history, threads);
      ASSERT_EQ(other.step_count(), one.step_count());
      ASSERT_EQ(other.edge_count(), one.edge_count());
      for (std::uint32_t k = 0; k < one.step_count(); ++k)
        ASSERT_TRUE(std::ranges::equal(one.of(k), other.of(k))) << threads << ", step " << k;
    }
  }
}

}  // namespace
}  // namespace varifold
