// What adapt() tells of the steps that nobody asked for.
#include <gtest/gtest.h>
#include <tests/models/vdpm/vdpm_support.h>
#include <varifold/models/vdpm/step_regions.h>
#include <cmath>

namespace varifold::test {
namespace {

// Steps that are split, but whose own region the view does not ask for.
std::uint32_t split_unasked(const ViewDependentInstance& instance, const RefineCriteria& criteria,
                            float tolerance) {
  const ViewDependentMesh& model = instance.model();
  const ViewQuery query(*criteria.view, tolerance, 1e20f);
  std::uint32_t count = 0;
  for (std::uint32_t step = 0; step < model.step_count(); ++step)
    count += instance.is_split(step) &&
             !query.test(own_region(model.bounds(step), model.center(step))).asked;
  return count;
}

TEST(ForcedSplits, OfAFreshFrontAreTheUnaskedOnes) {
  Random random(3);
  std::uint32_t all = 0;
  for (const NamedVdpm& named : all_vdpms()) {
    for (const float tolerance : {0.5f, 4.0f, 20.0f}) {
      const RefineCriteria criteria = random_view(named.model->bounding_ball(), random);
      ViewDependentInstance instance(named.model);
      const FrontStatistics told = instance.adapt(criteria, {tolerance});
      EXPECT_EQ(told.forced_splits, split_unasked(instance, criteria, tolerance)) << named.name;
      all += told.forced_splits;
      EXPECT_EQ(instance.adapt(criteria, {tolerance}).forced_splits, 0u) << named.name;
    }
  }
  EXPECT_GT(all, 100u);
}

}  // namespace
}  // namespace varifold::test
