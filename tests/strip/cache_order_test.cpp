#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <varifold/base/random.h>
#include <varifold/mesh/generators.h>
#include <varifold/strip/cache_order.h>
#include <algorithm>
#include <array>
#include <deque>
#include <vector>

namespace varifold {
namespace {

using Corners = std::vector<std::uint16_t>;

// A cache as one would draw it: a queue.
std::size_t misses_of(const Corners& corners, std::size_t size) {
  std::deque<std::uint16_t> queue;
  std::size_t misses = 0;
  for (const std::uint16_t v : corners) {
    if (std::find(queue.begin(), queue.end(), v) != queue.end()) continue;
    ++misses;
    queue.push_back(v);
    if (queue.size() > size) queue.pop_front();
  }
  return misses;
}

std::vector<std::array<std::uint16_t, 3>> sorted_triangles(const Corners& corners) {
  std::vector<std::array<std::uint16_t, 3>> triangles;
  for (std::size_t i = 0; i < corners.size(); i += 3)
    triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

Corners corners_of(const TriangleMesh& mesh) { return {mesh.indices.begin(), mesh.indices.end()}; }

void shuffle_triangles(Corners& corners, Random& random) {
  for (std::size_t i = corners.size() / 3; i > 1; --i) {
    const std::size_t j = random.below(static_cast<std::uint32_t>(i));
    std::swap_ranges(&corners[3 * (i - 1)], &corners[3 * (i - 1)] + 3, &corners[3 * j]);
  }
}

TEST(CacheOrder, KeepsTheTrianglesOfEveryGroupAndIsNeverWorse) {
  CacheOrder order(8);
  for (const auto& [name, mesh] : test::all_groups()) {
    SCOPED_TRACE(name);
    if (mesh.vertex_count() > 65536) continue;
    const Corners before = corners_of(mesh);
    Corners after = before;
    order.reorder(after, mesh.vertex_count());
    EXPECT_EQ(sorted_triangles(after), sorted_triangles(before)) << "with their first corners";
    EXPECT_LE(misses_of(after, 8), misses_of(before, 8));
    // What was ordered before leaves no trace.
    Corners alone = before;
    order_for_vertex_cache(alone, mesh.vertex_count(), 8);
    EXPECT_EQ(alone, after);
  }
}

TEST(CacheOrder, GivesTheOrderByNumber) {
  const TriangleMesh mesh = test::grid(9, 7);
  const Corners before = corners_of(mesh);
  CacheOrder order(4);
  Corners after;
  for (const std::uint32_t t : order.order(before, mesh.vertex_count()))
    after.insert(after.end(), &before[3 * std::size_t{t}], &before[3 * std::size_t{t}] + 3);
  Corners expected = before;
  order.reorder(expected, mesh.vertex_count());
  EXPECT_EQ(after, expected);
  EXPECT_NE(after, before);
}

TEST(CacheOrder, MissesFewOfSixteen) {
  Random random(7);
  PlanetOptions planet_options;
  planet_options.triangles = 20000;
  for (const TriangleMesh& mesh : {test::grid(25, 20), test::icosphere(1000), test::icosphere(5000),
                                   test::grid(70, 60), planet(planet_options)}) {
    Corners corners = corners_of(mesh);
    shuffle_triangles(corners, random);
    order_for_vertex_cache(corners, mesh.vertex_count(), 16);
    const double triangles = mesh.triangle_count();
    EXPECT_LE(misses_of(corners, 16) / triangles, 0.75) << mesh.triangle_count();
    EXPECT_LE(misses_of(corners, 32) / triangles, 0.72) << "larger caches gain, too";
  }
}

// Two fans around 0 and 5, by turns: a cache of four holds one centre and its rim.
TEST(CacheOrder, TakesOneFanAfterTheOther) {
  Corners corners;
  for (std::uint16_t i = 0; i < 3; ++i)
    for (const std::uint16_t center : {std::uint16_t{0}, std::uint16_t{5}})
      corners.insert(corners.end(), {center, static_cast<std::uint16_t>(center + 1 + i),
                                     static_cast<std::uint16_t>(center + 2 + i)});
  EXPECT_EQ(misses_of(corners, 4), 18u) << "all of them";
  order_for_vertex_cache(corners, 10, 4);
  EXPECT_EQ(corners, (Corners{0, 1, 2, 0, 2, 3, 0, 3, 4, 5, 6, 7, 5, 7, 8, 5, 8, 9}));
}

TEST(CacheOrder, TakesNothing) {
  CacheOrder order;
  EXPECT_TRUE(order.order({}, 0).empty());
  EXPECT_TRUE(order.order({}, 100).empty());
  const Corners loop{7, 7, 7};
  EXPECT_EQ(order.order(loop, 8).size(), 1u);
}

}  // namespace
}  // namespace varifold
