// What instances draw, against the front as a mesh by its definition.
#include <tests/support/count_allocations.h>

#include <gtest/gtest.h>
#include <tests/models/level_checks.h>
#include <tests/models/patch_tree/built_trees.h>

#include <varifold/base/random.h>
#include <varifold/models/patch_tree/extract.h>
#include <varifold/models/patch_tree/instance.h>
#include <algorithm>
#include <array>
#include <vector>

namespace varifold::test {
namespace {

// Triangles by what is at their corners, and the material.
using PlacedTriangle = std::array<float, 10>;

PlacedTriangle placed(const std::array<Vec3, 3>& corners, std::uint32_t material) {
  std::size_t least = 0;
  const auto key = [&](std::size_t k) {
    return std::array{corners[k].x, corners[k].y, corners[k].z};
  };
  for (std::size_t k = 1; k < 3; ++k)
    if (key(k) < key(least)) least = k;
  PlacedTriangle triangle{};
  for (std::size_t k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i)
      triangle[3 * k + static_cast<std::size_t>(i)] = corners[(least + k) % 3][i];
  triangle[9] = static_cast<float>(material);
  return triangle;
}

std::vector<PlacedTriangle> drawn_triangles(const DrawList& list) {
  std::vector<PlacedTriangle> triangles;
  for (const DrawRange& range : list.ranges)
    for (std::size_t i = range.first_index; i < range.first_index + std::size_t{range.index_count};
         i += 3)
      triangles.push_back(
          placed({list.positions[list.indices[i]], list.positions[list.indices[i + 1]],
                  list.positions[list.indices[i + 2]]},
                 range.material));
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// Word by word: the triangles of every node in the front, with vertices as they are drawn; those
// without an area by that are left out.
std::vector<PlacedTriangle> defined_triangles(const PatchTree& tree,
                                              const std::vector<std::uint8_t>& is_split,
                                              bool switches) {
  const PatchTreeData& data = tree.data();
  std::vector<PlacedTriangle> triangles;
  for (std::uint32_t node = 0; node < tree.node_count(); ++node) {
    const std::uint32_t parent = data.topology.parent[node];
    if (is_split[node] || (parent != kNone && !is_split[parent])) continue;
    const auto place = [&](std::uint16_t corner) {
      const PatchOffsets& at = data.offsets[node];
      if (switches && parent != kNone &&
          corner < data.offsets[node + 1].controller - at.controller) {
        const std::uint8_t bit = data.controllers[at.controller + corner];
        const std::uint32_t neighbor = data.topology.neighbors_of(parent)[bit];
        if (!is_split[neighbor])
          return data.vertices
              .positions[data.offsets[parent].vertex + data.survivors[at.vertex + corner]];
      }
      return data.vertices.positions[at.vertex + corner];
    };
    std::size_t t = data.offsets[node].triangle;
    for (std::uint32_t r = data.offsets[node].range; r < data.offsets[node + 1].range; ++r)
      for (std::uint32_t i = 0; i < data.ranges[r].triangle_count; ++i, ++t) {
        const std::array<Vec3, 3> c{place(data.corners[3 * t]), place(data.corners[3 * t + 1]),
                                    place(data.corners[3 * t + 2])};
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
        triangles.push_back(placed(c, data.ranges[r].material));
      }
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

struct Request {
  RefineCriteria criteria;
  AdaptOptions options;
};

// A sphere or a view somewhere near the surface, sometimes with a budget.
Request random_request(const BuiltTree& built, Random& random) {
  Request request;
  const std::vector<Vec3>& at = built.mesh.positions;
  Box box;
  for (const Vec3& p : at) box.add(p);
  const Vec3 place = at[random.below(static_cast<std::uint32_t>(at.size()))];
  if (random.below(2) == 0) {
    request.criteria.sphere =
        Sphere{place, static_cast<float>(0.3 * random.uniform()) * box.diagonal()};
  } else {
    Camera camera;
    camera.eye = place + Vec3(0.1f, 0.2f, 0.3f) * (2 * box.diagonal());
    camera.target = place;
    camera.near_distance = 1e-3f * box.diagonal();
    camera.far_distance = 10 * box.diagonal();
    request.criteria.view.emplace(camera);
    request.options.tolerance = static_cast<float>(0.2 + 4 * random.uniform());
  }
  if (random.below(2) == 0)
    request.options.max_triangles =
        random.below(built.tree->triangle_count(built.tree->finest_level()) + 1);
  return request;
}

TEST(PatchTreeInstance, DrawsEveryLevelByDefinition) {
  for (const BuiltTree& built : built_trees()) {
    SCOPED_TRACE(built.name);
    PatchTreeInstance instance(built.tree);
    const PatchTopology& t = built.tree->topology();
    for (std::uint32_t level = 0; level <= built.tree->finest_level(); ++level) {
      instance.go_to_level(level);
      EXPECT_EQ(instance.level(), level);
      std::vector<std::uint8_t> is_split(t.node_count(), 0);
      if (t.node_count() > 0)
        std::fill(is_split.begin(), is_split.begin() + t.first_of_level[level], 1);
      EXPECT_EQ(instance.split_flags(), is_split);
      EXPECT_EQ(instance.triangle_count(), built.tree->triangle_count(level));
      EXPECT_EQ(instance.vertex_count(), built.tree->vertex_count(level));
      // Nothing is switched where all are of one level.
      EXPECT_EQ(instance.collapsed_triangles(), 0u);
      const auto drawn = drawn_triangles(instance.draw_list());
      ASSERT_EQ(drawn, defined_triangles(*built.tree, is_split, true)) << level;
      EXPECT_EQ(drawn.size(), instance.triangle_count());
    }
    // The finest level is the mesh.
    EXPECT_LE(instance.triangle_count(), built.mesh.triangle_count());
    instance.go_to_level(0xffffffffu);
    EXPECT_EQ(instance.level(), built.tree->finest_level());
  }
}

TEST(PatchTreeInstance, DrawsEveryFrontByDefinition) {
  Random random(8);
  std::uint32_t collapsed = 0, mixed = 0;
  for (const BuiltTree& built : built_trees()) {
    if (built.mesh.positions.empty()) continue;
    SCOPED_TRACE(built.name);
    PatchTreeInstance instance(built.tree);
    DeviceCopy device;
    for (int i = 0; i < 12; ++i) {
      const Request request = random_request(built, random);
      const FrontStatistics front = instance.adapt(request.criteria, request.options);
      EXPECT_EQ(instance.level(), kNone);
      EXPECT_EQ(front.triangles, instance.triangle_count());
      EXPECT_TRUE(front.triangles <= request.options.max_triangles ||
                  front.triangles == built.tree->triangle_count(0));
      const std::vector<std::uint8_t> is_split = instance.split_flags();
      ASSERT_TRUE(is_legal(built.tree->topology(), is_split));
      if (i % 5 == 4) instance.go_to_level(i / 5);
      const bool switches = i % 4 != 3;
      instance.set_switches(switches);
      const DrawList list = instance.draw_list();
      const auto drawn = drawn_triangles(list);
      ASSERT_EQ(drawn, defined_triangles(*built.tree, instance.split_flags(), switches)) << i;
      EXPECT_EQ(drawn.size() + instance.collapsed_triangles(), instance.triangle_count());
      collapsed += instance.collapsed_triangles();
      mixed += instance.collapsed_triangles() > 0 ? 1 : 0;
      // The same triangles from what a device has.
      device.take(list);
      DrawList on_device = list;
      on_device.indices = device.indices;
      ASSERT_EQ(drawn_triangles(on_device), drawn) << i;
      EXPECT_TRUE(instance.draw_list().changed_indices.empty());
      const TriangleMesh mesh = instance.extract();
      EXPECT_EQ(mesh.triangle_count(), drawn.size());
    }
  }
  EXPECT_GT(collapsed, 100u);
  EXPECT_GT(mixed, 20u);
}

TEST(PatchTreeInstance, RangesNameTheirPatches) {
  const BuiltTree& built = built_tree("blob of patches of 40");
  PatchTreeInstance instance(built.tree);
  RefineCriteria criteria;
  criteria.sphere = Sphere{built.mesh.positions[0], 0.5f};
  (void)instance.adapt(criteria);
  const DrawList list = instance.draw_list();
  ASSERT_EQ(instance.nodes_of_ranges().size(), list.ranges.size());
  const std::vector<std::uint8_t> is_split = instance.split_flags();
  const auto finest = static_cast<float>(built.tree->finest_level());
  for (std::size_t r = 0; r < list.ranges.size(); ++r) {
    const std::uint32_t node = instance.nodes_of_ranges()[r];
    EXPECT_TRUE(is_in_front(built.tree->topology(), is_split, node));
    EXPECT_EQ(list.ranges[r].level, static_cast<float>(built.tree->level_of(node)) / finest);
  }
}

TEST(PatchTreeInstance, AllocatesNothingOnceItHasShownAsMuch) {
  const BuiltTree& built = built_tree("blob of patches of 40");
  PatchTreeInstance instance(built.tree);
  const auto walk = [&] {
    Random random(3);
    for (int i = 0; i < 30; ++i) {
      const Request request = random_request(built, random);
      (void)instance.adapt(request.criteria, request.options);
      (void)instance.draw_list();
      if (i % 7 == 0) instance.go_to_level(random.below(9));
    }
  };
  walk();
  const std::size_t before = allocations;
  walk();
  EXPECT_EQ(allocations, before);
}

// The greatest error of the patches that are drawn.
float error_of(const PatchTree& tree, const std::vector<std::uint8_t>& is_split) {
  float error = 0;
  for (std::uint32_t node = 0; node < tree.node_count(); ++node)
    if (is_in_front(tree.topology(), is_split, node))
      error = std::max(error, tree.data().bounds[node].error);
  return error;
}

// Triangles of the smallest legal front in which all nodes of at least that error are split.
std::uint64_t triangles_below(const PatchTree& tree, float error) {
  const PatchTopology& t = tree.topology();
  std::vector<std::uint8_t> is_split(t.node_count(), 0);
  for (std::uint32_t node = 0; node < t.node_count(); ++node)
    is_split[node] = !t.is_leaf(node) && tree.data().bounds[node].error >= error ? 1 : 0;
  // Parents have smaller numbers.
  for (std::uint32_t node = t.node_count(); node-- > 0;) {
    if (is_split[node] == 0 || t.parent[node] == kNone) continue;
    is_split[t.parent[node]] = 1;
    for (const std::uint32_t neighbor : t.neighbors_of(node)) is_split[t.parent[neighbor]] = 1;
  }
  std::uint64_t triangles = 0;
  for (std::uint32_t node = 0; node < t.node_count(); ++node)
    if (is_in_front(t, is_split, node)) triangles += tree.triangle_count_of(node);
  return triangles;
}

TEST(PatchTreeInstance, FindsTheFrontOfLeastErrorForANumberOfTriangles) {
  Random random(44);
  int mixed = 0, better = 0;
  for (const BuiltTree& built : built_trees()) {
    const PatchTree& tree = *built.tree;
    if (tree.node_count() == 0) continue;
    SCOPED_TRACE(built.name);
    PatchTreeInstance instance(built.tree);
    const std::uint32_t most = tree.triangle_count(tree.finest_level());
    std::vector<std::uint32_t> budgets{0, tree.triangle_count(0), most - 1, most, most + 1, kNone};
    for (int i = 0; i < 20; ++i) budgets.push_back(random.below(most + 1));
    for (std::uint32_t level = 0; level < tree.finest_level(); ++level)
      budgets.push_back(tree.triangle_count(level));
    for (const std::uint32_t budget : budgets) {
      const PatchFrontResult found = instance.go_to_triangles(budget);
      const std::vector<std::uint8_t> split = instance.split_flags();
      ASSERT_TRUE(is_legal(tree.topology(), split));
      const float error = error_of(tree, split);
      EXPECT_EQ(found.statistics.tolerance, error) << budget;
      EXPECT_EQ(found.statistics.triangles, instance.triangle_count());
      EXPECT_EQ(found.is_over_budget, budget < tree.triangle_count(0));
      if (found.is_over_budget) {
        EXPECT_EQ(instance.triangle_count(), tree.triangle_count(0));
        continue;
      }
      EXPECT_LE(instance.triangle_count(), budget);
      const std::uint32_t level = tree.level_for_triangles(budget);
      EXPECT_LE(error, tree.error(level));
      if (error > 0) {
        EXPECT_GT(triangles_below(tree, error), budget);
      }
      if (budget >= most) {
        EXPECT_EQ(instance.level(), tree.finest_level());
      }
      mixed += instance.collapsed_triangles() > 0 ? 1 : 0;
      better += error < tree.error(level) ? 1 : 0;
    }
  }
  EXPECT_GT(mixed, 40);
  EXPECT_GT(better, 40);
}

TEST(PatchTree, FindsLevels) {
  for (const BuiltTree& built : built_trees()) {
    const PatchTree& tree = *built.tree;
    const std::uint32_t finest = tree.finest_level();
    EXPECT_EQ(tree.level_for_fraction(1), finest);
    EXPECT_EQ(tree.level_for_fraction(0), 0u);
    for (std::uint32_t level = 0; level <= finest; ++level) {
      if (level > 0) {
        EXPECT_LE(tree.error(level), tree.error(level - 1));
        EXPECT_LE(tree.triangle_count(level - 1), tree.triangle_count(level));
      }
      EXPECT_GE(tree.level_for_triangles(tree.triangle_count(level)), level);
      EXPECT_GE(tree.level_for_vertices(tree.vertex_count(level)), level);
      const std::uint32_t coarsest = tree.level_for_error(tree.error(level));
      EXPECT_TRUE(coarsest <= level && tree.error(coarsest) <= tree.error(level));
    }
    if (tree.node_count() > 0) {
      EXPECT_EQ(tree.level_for_triangles(0), 0u);
      EXPECT_EQ(tree.error(finest), 0);
    }
  }
}

}  // namespace
}  // namespace varifold::test
