#include <varifold/simplify/collapse_fan.h>

#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <varifold/base/random.h>
#include <varifold/mesh/generators.h>
#include <varifold/simplify/closest_on_triangle.h>
#include <limits>

namespace varifold {
namespace {

// Against the distance to each triangle by itself, which goes another way: by regions.
TEST(FanDistances, AreThoseToTheNearestTriangle) {
  InputFaults faults;
  WorkingSurface surface = build_surface(planet({{.triangles = 400}}), {}, faults);
  Random random(3);
  const auto coordinate = [&] { return static_cast<float>(random.uniform()) - 0.5f; };
  std::vector<FanFace> fan;
  FanDistances distances;
  for (std::uint32_t from = 0; from < surface.point_count(); ++from) {
    const std::uint32_t onto = surface.ring(from)[0].neighbor;
    for (const bool moves : {false, true}) {
      make_fan(surface, {from, onto, moves}, fan);
      ASSERT_FALSE(fan.empty());
      const Vec3 apex = surface.points[onto].position + 0.05f * Vec3(coordinate());
      distances.clear();
      const std::uint32_t samples = 1 + random.below(100);
      for (std::uint32_t i = 0; i < samples; ++i)
        distances.add(apex + 0.3f * Vec3(coordinate(), coordinate(), coordinate()));
      distances.find_nearest(surface, fan, apex);
      double sum = 0;
      for (std::size_t i = 0; i < distances.size(); ++i) {
        float least = std::numeric_limits<float>::infinity(), at_nearest = 0;
        for (std::size_t f = 0; f < fan.size(); ++f) {
          const Vec3 p = distances[i];
          const Vec3 foot = closest_on_triangle(apex - p, surface.points[fan[f].m].position - p,
                                                surface.points[fan[f].n].position - p)
                                .position;
          if (f == distances.nearest(i)) at_nearest = glm::dot(foot, foot);
          least = std::min(least, glm::dot(foot, foot));
        }
        ASSERT_NEAR(distances.squared(i), least, 1e-4f * least + 1e-9f);
        ASSERT_NEAR(at_nearest, least, 1e-4f * least + 1e-9f);
        sum += distances.squared(i);
      }
      const double infinity = std::numeric_limits<double>::infinity();
      EXPECT_EQ(distances.sum(surface, fan, apex, infinity), sum);
      EXPECT_GT(distances.sum(surface, fan, apex, 0.5 * sum), 0.5 * sum);
    }
  }
}

TEST(CollapseFan, OfAHalfEdgeCollapseInAGrid) {
  InputFaults faults;
  WorkingSurface surface = build_surface(test::grid(6, 6), {}, faults);
  std::uint32_t inner = kNone;
  for (std::uint32_t p = 0; p < surface.point_count(); ++p)
    if (surface.points[p].ring_size == 6) {
      bool all_inner = true;
      for (const RingEntry& entry : surface.ring_span(p))
        all_inner = all_inner && surface.points[entry.neighbor].ring_size == 6;
      if (all_inner) inner = p;
    }
  ASSERT_NE(inner, kNone);
  std::vector<FanFace> fan;
  make_fan(surface, {inner, surface.ring(inner)[0].neighbor, false}, fan);
  int changing = 0;
  for (const FanFace& face : fan) changing += face.changes;
  EXPECT_EQ(changing, 4);  // of six faces two vanish
  EXPECT_EQ(fan.size(), 6u);
  make_fan(surface, {inner, surface.ring(inner)[0].neighbor, true}, fan);
  EXPECT_EQ(fan.size(), 8u);
  std::vector<std::uint32_t> faces;
  changed_faces(surface, {inner, surface.ring(inner)[0].neighbor, true}, faces);
  EXPECT_EQ(faces.size(), 10u);
}

}  // namespace
}  // namespace varifold
