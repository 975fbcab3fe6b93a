#include <gtest/gtest.h>
#include <tests/models/patch_tree/tree_fronts.h>
#include <tests/support/meshes.h>
#include <tests/support/test_files.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/weld.h>
#include <varifold/models/patch_tree/build.h>
#include <varifold/models/patch_tree/extract.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <string_view>
#include <thread>

namespace varifold {
namespace {

PatchTreeBuild build(const TriangleMesh& mesh, std::uint32_t triangles, int threads = 1) {
  PatchTreeOptions options;
  options.triangles_per_patch = triangles;
  options.threads = threads;
  auto result = build_patch_tree(mesh, options);
  EXPECT_TRUE(result.has_value());
  return std::move(*result);
}

TriangleMesh planet_of(std::uint32_t triangles) {
  PlanetOptions options;
  options.triangles = triangles;
  return planet(options);
}

// Fronts of all sorts, and every uniform one.
void expect_sound(const PatchTree& tree, int fronts, std::uint64_t seed) {
  const PatchTopology& topology = tree.topology();
  const test::WholeSurface whole(tree);
  Random random(seed);
  for (int i = 0; i < fronts; ++i) {
    const test::SplitNodes front = test::random_front(topology, random);
    ASSERT_EQ(test::fault_of_front(tree, front, whole), "") << "front " << i;
    ASSERT_EQ(test::turned_triangles(tree.data(), front), 0u) << "front " << i;
  }
  for (std::uint32_t level = 0; level < topology.level_count(); ++level)
    ASSERT_EQ(test::fault_of_front(tree, test::uniform_front(topology, level), whole), "")
        << "level " << level;
}

TEST(PatchTreeBuild, EveryFrontOfEveryGroupIsSound) {
  for (const auto& [name, mesh] : test::all_groups()) {
    for (const std::uint32_t triangles : {4u, 16u, 100u}) {
      SCOPED_TRACE(name + " " + std::to_string(triangles));
      const PatchTreeBuild built = build(mesh, triangles);
      if (built.tree.node_count() == 0) continue;
      const TopologyReport whole = test::WholeSurface(built.tree).topology();
      const TopologyReport input = analyze_topology(mesh, weld_exact(mesh.positions), 1);
      EXPECT_EQ(whole.euler_characteristic,
                input.euler_characteristic - built.report.faults.duplicate_triangles);
      EXPECT_EQ(whole.boundary_edges, input.boundary_edges);
      expect_sound(built.tree, 60, triangles);
    }
  }
}

TEST(PatchTreeBuild, HalvesExactlyDownToOnePatch) {
  const std::vector<std::pair<TriangleMesh, std::uint32_t>> meshes = {{planet_of(30000), 64},
                                                                      {test::grid(70, 50), 100}};
  for (const auto& [mesh, triangles] : meshes) {
    const PatchTreeBuild built = build(mesh, triangles);
    const auto& levels = built.report.level_triangles;
    const auto& patches = built.report.level_patches;
    EXPECT_EQ(built.report.stop, TreeStop::kOneRoot);
    EXPECT_EQ(patches.back(), 1u);
    for (std::size_t i = 1; i < levels.size(); ++i) {
      EXPECT_LE(levels[i], (levels[i - 1] + 1) / 2);
      EXPECT_GE(levels[i] + 2, levels[i - 1] / 2);
      EXPECT_EQ(patches[i], (patches[i - 1] + 1) / 2);
    }
    expect_sound(built.tree, 100, 1);
  }
}

// A thousand spheres that cannot be made smaller than tetrahedra each: some go, as a whole.
TEST(PatchTreeBuild, SmallComponentsVanishAsAWhole) {
  TriangleMesh mesh = test::icosphere(2000);
  mesh.normals.clear();
  const TriangleMesh small = test::octahedron();
  for (int i = 0; i < 300; ++i)
    mesh = test::join(
        mesh, small,
        Vec3(3.0f + 3.0f * static_cast<float>(i % 10), 3.0f * static_cast<float>(i / 10 % 10),
             3.0f * static_cast<float>(i / 100)));
  const PatchTreeBuild built = build(mesh, 100);
  EXPECT_EQ(built.report.stop, TreeStop::kOneRoot);
  EXPECT_LE(built.report.level_triangles.back(), 250u);
  EXPECT_GT(built.report.vanished_points, 0u);
  expect_sound(built.tree, 100, 2);
}

TEST(PatchTreeBuild, DoesNotDependOnThreads) {
  const TriangleMesh mesh = planet_of(100000);
  const PatchTree one = build(mesh, 100, 1).tree;
  for (const int threads : {2, 3}) {
    const PatchTree other = build(mesh, 100, threads).tree;
    EXPECT_EQ(one.data().corners, other.data().corners);
    EXPECT_EQ(one.data().survivors, other.data().survivors);
    EXPECT_EQ(one.data().controllers, other.data().controllers);
    EXPECT_EQ(one.data().vertices.positions, other.data().vertices.positions);
    EXPECT_EQ(one.data().vertices.normals, other.data().vertices.normals);
    EXPECT_EQ(one.topology().neighbors, other.topology().neighbors);
    for (std::uint32_t n = 0; n < one.node_count(); ++n)
      ASSERT_EQ(one.data().bounds[n].error, other.data().bounds[n].error);
  }
}

TEST(PatchTreeBuild, ReportsOnTheThreadOfTheCaller) {
  std::set<std::string> stages;
  PatchTreeOptions options;
  options.triangles_per_patch = 100;
  options.threads = 2;
  options.progress = [&, caller = std::this_thread::get_id()](std::string_view stage, float) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    stages.emplace(stage);
    return true;
  };
  ASSERT_TRUE(build_patch_tree(planet_of(100000), options));
  EXPECT_EQ(stages, (std::set<std::string>{"patches", "simplifying"}));
}

TEST(PatchTreeBuild, IsCancelledAtAnyStage) {
  for (const std::string_view last : {"patches", "simplifying"}) {
    PatchTreeOptions options;
    options.threads = 2;
    options.progress = [&](std::string_view stage, float) { return stage != last; };
    const auto built = build_patch_tree(planet_of(20000), options);
    ASSERT_FALSE(built);
    EXPECT_EQ(built.error().kind, ErrorKind::kCancelled);
  }
}

// The unit sphere with a tube from its north pole on, turned around the z axis.
TriangleMesh sphere_with_spike(float radius, float length) {
  constexpr std::uint32_t kAround = 48, kSphereRings = 60, kSpikeRings = 40;
  TriangleMesh mesh;
  std::vector<Vec2> profile;  // distance from the axis, height
  const float top = std::asin(radius);
  for (std::uint32_t i = 1; i <= kSphereRings; ++i) {
    const float angle = (std::numbers::pi_v<float> - top) * static_cast<float>(i) / kSphereRings;
    profile.emplace_back(std::sin(angle), -std::cos(angle));
  }
  for (std::uint32_t i = 1; i <= kSpikeRings; ++i)
    profile.emplace_back(
        radius, profile[kSphereRings - 1].y + length * static_cast<float>(i) / kSpikeRings);
  mesh.positions.emplace_back(0.0f, 0.0f, -1.0f);
  for (const Vec2& p : profile)
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kAround;
      mesh.positions.emplace_back(p.x * std::cos(angle), p.x * std::sin(angle), p.y);
    }
  mesh.positions.emplace_back(0.0f, 0.0f, profile.back().y + radius);
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  const auto rings = static_cast<std::uint32_t>(profile.size());
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const std::uint32_t next = (i + 1) % kAround;
    mesh.indices.insert(mesh.indices.end(), {0, 1 + next, 1 + i});
    for (std::uint32_t r = 0; r + 1 < rings; ++r) {
      const std::uint32_t a = 1 + r * kAround + i, b = 1 + r * kAround + next;
      mesh.indices.insert(mesh.indices.end(), {a, b, b + kAround, a, b + kAround, a + kAround});
    }
    const std::uint32_t top_ring = 1 + (rings - 1) * kAround;
    mesh.indices.insert(mesh.indices.end(), {top_ring + i, top_ring + next, last});
  }
  return mesh;
}

// A spike has no area to speak of, but a length that anybody sees.
TEST(PatchTreeBuild, ThinSpikesStay) {
  const TriangleMesh mesh = sphere_with_spike(0.002f, 1.0f);
  const PatchTree tree = build(mesh, 64).tree;
  const PatchTopology& topology = tree.topology();
  ASSERT_GT(topology.level_count(), 4u);
  for (std::uint32_t l = topology.level_count() - 4; l < topology.level_count(); ++l)
    for (std::uint32_t node = topology.first_of_level[l]; node < topology.first_of_level[l + 1];
         ++node)
      EXPECT_LT(tree.data().bounds[node].error, 0.1f) << "level " << l;
}

TEST(PatchTreeBuild, BoundsNestAndErrorsSaturate) {
  const PatchTreeBuild built = build(planet_of(30000), 64);
  const PatchTreeData& tree = built.tree.data();
  for (std::uint32_t node = 0; node < built.tree.node_count(); ++node) {
    const PatchBounds& bounds = tree.bounds[node];
    for (std::uint32_t v = tree.offsets[node].vertex; v < tree.offsets[node + 1].vertex; ++v)
      EXPECT_LE(glm::length(tree.vertices.positions[v] - bounds.ball.center), bounds.ball.radius);
    EXPECT_EQ(bounds.error == 0, tree.topology.is_leaf(node));
    const std::uint32_t parent = tree.topology.parent[node];
    if (parent == kNone) continue;
    const PatchBounds& above = tree.bounds[parent];
    EXPECT_LE(bounds.error, above.error);
    EXPECT_LE(bounds.mean_squared, above.mean_squared);
    EXPECT_LE(glm::length(bounds.ball.center - above.ball.center) + bounds.ball.radius,
              above.ball.radius * 1.00001f);
    EXPECT_TRUE(above.cone.is_wide() ||
                glm::dot(bounds.cone.axis, above.cone.axis) >= above.cone.cosine - 1e-5f);
  }
}

TEST(PatchTreeBuild, KeepsAMaterialThatIsNotTheFirst) {
  TriangleMesh mesh = test::grid(8, 8);
  mesh.materials.resize(3);
  mesh.ranges = {{2, 0, mesh.triangle_count()}};
  const PatchTree tree = build(mesh, 16).tree;
  for (const PatchRange& range : tree.data().ranges) EXPECT_EQ(range.material, 2u);
}

TEST(PatchTreeBuild, RefusesWhatIsNoMesh) {
  TriangleMesh mesh = test::tetrahedron();
  mesh.indices[4] = 99;
  EXPECT_FALSE(build_patch_tree(mesh).has_value());
  EXPECT_EQ(build({}, 100).tree.node_count(), 0u);
  EXPECT_EQ(build(test::tetrahedron(), 100).tree.node_count(), 1u);
}

}  // namespace
}  // namespace varifold
