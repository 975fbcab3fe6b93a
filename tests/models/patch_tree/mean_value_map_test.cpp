#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <varifold/mesh/generators.h>
#include <varifold/models/patch_tree/build.h>
#include <varifold/models/patch_tree/mean_value_map.h>
#include <cmath>
#include <vector>

namespace varifold {
namespace {

std::vector<float> map_grid(std::vector<Vec3> positions, std::vector<std::uint8_t> is_locked) {
  const TriangleMesh mesh = test::grid(8, 8);
  std::vector<float> squared(positions.size());
  map_by_mean_values({mesh.indices, positions, is_locked}, squared);
  return squared;
}

bool is_on_rim(const Vec3& p) { return p.x == 0 || p.y == 0 || p.x == 8 || p.y == 8; }

// Mean value coordinates reproduce places in a plane: with the rim locked nothing moves.
TEST(MeanValueMap, ReproducesThePlane) {
  const std::vector<Vec3> positions = test::grid(8, 8).positions;
  std::vector<std::uint8_t> is_locked;
  for (const Vec3& p : positions) is_locked.push_back(is_on_rim(p) ? 1 : 0);
  for (const float squared : map_grid(positions, is_locked)) EXPECT_NEAR(squared, 0, 1e-5);
}

// One place above a plane falls back to it, the more its neighbours are held the further.
TEST(MeanValueMap, MeasuresWhatStandsOut) {
  std::vector<Vec3> positions = test::grid(8, 8).positions;
  std::vector<std::uint8_t> is_locked(positions.size(), 1);
  std::size_t middle = 0;
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (positions[v] == Vec3(4, 4, 0)) middle = v;
  is_locked[middle] = 0;
  positions[middle].z = 1;
  const std::vector<float> squared = map_grid(positions, is_locked);
  EXPECT_NEAR(squared[middle], 1, 0.05);
  for (std::size_t v = 0; v < squared.size(); ++v) EXPECT_TRUE(v == middle || squared[v] == 0) << v;
}

TEST(MeanValueMap, RimsSlideAlongThemselves) {
  std::vector<Vec3> positions = test::grid(8, 8).positions;
  std::vector<std::uint8_t> is_locked;
  for (const Vec3& p : positions)
    is_locked.push_back((p.x == 0 || p.x == 8) && (p.y == 0 || p.y == 8) ? 1 : 0);
  for (const float squared : map_grid(positions, is_locked)) EXPECT_NEAR(squared, 0, 1e-3);
}

TEST(MeanValueMap, WhatNothingHoldsHasNoPlace) {
  const std::vector<Vec3> positions = test::grid(8, 8).positions;
  for (const float squared : map_grid(positions, std::vector<std::uint8_t>(positions.size(), 0)))
    EXPECT_LT(squared, 0);
}

TEST(MeanValueMap, GivesPrioritiesAboveThoseOfClosestPoints) {
  PlanetOptions shape;
  shape.triangles = 20000;
  const TriangleMesh mesh = planet(shape);
  PatchTreeOptions options;
  options.triangles_per_patch = 100;
  const auto closest = build_patch_tree(mesh, options);
  options.priority = PatchPriority::kMeanValue;
  const auto mapped = build_patch_tree(mesh, options);
  ASSERT_EQ(closest->tree.node_count(), mapped->tree.node_count());
  for (std::uint32_t node = 0; node < mapped->tree.node_count(); ++node) {
    const float a = closest->tree.data().bounds[node].mean_squared;
    const float b = mapped->tree.data().bounds[node].mean_squared;
    // An image is a place near by, the closest point the nearest of all, or nearly.
    const float radius = mapped->tree.data().bounds[node].ball.radius;
    EXPECT_GE(b, 0.7f * a) << node;
    EXPECT_LE(b, 0.1f * radius * radius) << node;
    EXPECT_EQ(closest->tree.data().bounds[node].error, mapped->tree.data().bounds[node].error);
  }
}

}  // namespace
}  // namespace varifold
