// What adapt() tells of the steps that nobody asked for.
#include <gtest/gtest.h>
#include <tests/models/vdpm/vdpm_support.h>
#include <varifold/models/vdpm/step_regions.h>
#include <cmath>

namespace varifold::test {
namespace {

RefineCriteria view_of(const ViewDependentMesh& model, Random& random) {
  const Sphere ball = model.bounding_ball();
  const float radius = std::max(ball.radius, 0.1f);
  const auto part = [&] { return static_cast<float>(2 * random.uniform() - 1); };
  Camera camera;
  camera.target = ball.center;
  camera.eye = ball.center + radius * (Vec3(1.3f, 0.4f, 1.1f) + Vec3(part(), part(), part()));
  set_depth_range(camera, ball);
  RefineCriteria criteria;
  criteria.view.emplace(camera);
  return criteria;
}

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
      const RefineCriteria criteria = view_of(*named.model, random);
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
