// Deviations as they are seen and as lengths, and what fronts make of the tolerance then.
#include <gtest/gtest.h>
#include <tests/models/vdpm/vdpm_support.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/generators.h>
#include <varifold/models/vdpm/step_regions.h>
#include <algorithm>
#include <array>
#include <cmath>

namespace varifold::test {
namespace {

// All steps whose greater bound is seen too large from the nearest point of their ball, facing and
// in the frustum aside, and all that they require.
std::vector<bool> front_by_lengths(const ViewDependentMesh& model, const RefineCriteria& criteria,
                                   float tolerance) {
  const ViewQuery query(*criteria.view, tolerance, 1e20f);
  std::vector<bool> split(model.step_count());
  for (std::uint32_t step = model.step_count(); step-- > 0;) {
    const StepBounds bounds = model.bounds(step);
    const ViewRegion region{model.center(step), bounds.radius_length(), bounds.own_cone(),
                            std::max(bounds.mu_length(), bounds.delta_length()), 0};
    if (query.test(region).asked) split[step] = true;
    if (split[step])
      model.for_each_required(step, [&](std::uint32_t required) { split[required] = true; });
  }
  return split;
}

// The camera rests while the measure changes, so that nothing falls due but by the change itself.
TEST(DeviationMeasure, OfLengthsIsThatOfTheGreaterBoundInAllDirections) {
  Random random(8);
  std::uint32_t more = 0;
  for (const NamedVdpm& named : all_vdpms()) {
    ViewDependentInstance instance(named.model);
    for (const float tolerance : {0.5f, 4.0f, 20.0f}) {
      RefineCriteria criteria = random_view(named.model->bounding_ball(), random);
      // With a place of the user steps are asked one by one, and not in batches.
      if (tolerance == 4) criteria.sphere = Sphere{Vec3(1e6f), 1};
      const std::uint32_t seen = instance.adapt(criteria, {tolerance}).triangles;
      criteria.view->deviation = DeviationMeasure::kLength;
      const std::uint32_t length = instance.adapt(criteria, {tolerance}).triangles;
      const std::vector<bool> wanted = front_by_lengths(*named.model, criteria, tolerance);
      for (std::uint32_t step = 0; step < wanted.size(); ++step)
        ASSERT_EQ(instance.is_split(step), wanted[step]) << named.name << ", step " << step;
      ASSERT_LE(seen, length) << named.name;
      more += length > seen;
      criteria.view->deviation = DeviationMeasure::kSeen;
      ASSERT_EQ(instance.adapt(criteria, {tolerance}).triangles, seen) << named.name;
    }
  }
  EXPECT_GT(more, 20u);
}

// The greatest distance of points of a mesh from a front, in pixels.
double greatest_pixels(const TriangleMesh& mesh, const TriangleMesh& front, const PixelScale& scale,
                       Random& random) {
  const SurfaceDistance surface(front);
  double most = 0;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 20; ++i) {
      const std::uint32_t* const c = &mesh.indices[3 * std::size_t{t}];
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const DVec3 a(mesh.positions[c[0]]), b(mesh.positions[c[1]]), d(mesh.positions[c[2]]);
      const DVec3 p = a + u * (b - a) + v * (d - a);
      most = std::max(most, surface.distance(p) * scale.pixels_of(1, Vec3(p)));
    }
  return most;
}

// Without the points on edges it is more than twice the tolerance.
TEST(DeviationMeasure, OfLengthsBoundsPointsBetweenTheSamples) {
  for (const char* const shape : {"planet", "torus"}) {
    const auto mesh = generate(shape, {.triangles = 6000});
    const DetailedMesh detailed = simplify(*mesh, {.measure_error = false})->detailed;
    std::array<double, 2> greatest{};
    for (const std::uint32_t on_edges : {0u, 3u}) {
      const auto model = std::make_shared<const ViewDependentMesh>(
          build_view_dependent_mesh(detailed, {.on_edges = on_edges}));
      ViewDependentInstance instance(model);
      Random random(2);
      for (int i = 0; i < 6; ++i) {
        RefineCriteria criteria = random_view(model->bounding_ball(), random);
        criteria.view->outside_weight = criteria.view->back_weight = 1;
        criteria.view->deviation = DeviationMeasure::kLength;
        const float tolerance = i % 2 == 0 ? 1.0f : 4.0f;
        instance.adapt(criteria, {tolerance});
        double& most = greatest[on_edges > 0];
        most = std::max(
            most,
            greatest_pixels(*mesh, instance.extract(), criteria.view->scale, random) / tolerance);
      }
    }
    EXPECT_LT(greatest[1], 1.2) << shape;
    EXPECT_GT(greatest[0], 2) << shape;
  }
}

}  // namespace
}  // namespace varifold::test
