#include <varifold/simplify/star_triangles.h>

#include <gtest/gtest.h>
#include <tests/view/random_points.h>
#include <varifold/measure/closest_point.h>

namespace varifold {
namespace {

TEST(NearestTriangle, IsTheNearestAndTheFirstOfThem) {
  Random random(1);
  for (int trial = 0; trial < 3000; ++trial) {
    // A fan, as collapses leave them, or loose triangles; flat, bent, needles and single points.
    const Vec3 far = trial % 5 == 0 ? Vec3(1000, -2000, 500) : Vec3(0);
    const float thin = trial % 3 == 0 ? 1e-5f : 1.0f;
    const std::uint32_t count = 1 + random.below(11);
    std::vector<StarTriangle> triangles;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto point = [&] {
        return test::point_in_cube(random, 1) * Vec3(1, 1, trial % 4 == 0 ? 0.0f : thin) + far;
      };
      const bool in_fan = i > 0 && trial % 2 == 0;
      const Vec3 a = in_fan ? triangles[0].corners[0] : point();
      const Vec3 b = in_fan ? triangles[i - 1].corners[2] : point();
      triangles.push_back({i, {a, b, random.below(20) == 0 ? b : point()}});
    }
    NearestTriangle nearest;
    nearest.reset(triangles);
    NearestBatch batch{};
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = test::point_in_cube(random, i % 2 == 0 ? 1.0f : 3.0f) + far;
      Vec3 way;
      const std::size_t found = nearest.find(p, way);
      // The rule without its short cut, to the bit: ...
      std::size_t first = 0;
      NearestPoint least{Vec3(0), std::numeric_limits<float>::infinity()};
      double distance = std::numeric_limits<double>::infinity();
      for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto& c = triangles[t].corners;
        const NearestPoint other = nearest_on_triangle(c[0] - p, c[1] - p, c[2] - p);
        if (other.order < least.order) least = other, first = t;
        distance = std::min(distance, glm::length(closest_on_triangle(DVec3(p), DVec3(c[0]),
                                                                      DVec3(c[1]), DVec3(c[2])) -
                                                  DVec3(p)));
      }
      ASSERT_EQ(found, first);
      ASSERT_EQ(way, least.point);
      const std::size_t lane = static_cast<std::size_t>(i) % NearestBatch::kSize;
      batch.x[lane] = p.x, batch.y[lane] = p.y, batch.z[lane] = p.z;
      NearestBatch plain = batch;
      nearest.find(batch);
      star_triangles::find_nearest_plain(triangles, plain);
      for (const NearestBatch& b : {batch, plain}) {
        ASSERT_EQ(static_cast<std::size_t>(b.found[lane]), first);
        ASSERT_EQ(Vec3(b.way_x[lane], b.way_y[lane], b.way_z[lane]), least.point);
      }
      // ... and by brute force.
      ASSERT_NEAR(glm::length(DVec3(way)), distance, 1e-5 * (1 + glm::length(way)));
    }
  }
}

}  // namespace
}  // namespace varifold
