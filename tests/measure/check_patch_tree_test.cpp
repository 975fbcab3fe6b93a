// The check of patch trees finds nothing where there is nothing, and what was broken where there
// is.
#include <gtest/gtest.h>
#include <tests/models/patch_tree/built_trees.h>

#include <varifold/base/checksum.h>
#include <varifold/measure/check_patch_tree.h>
#include <varifold/measure/legal_fronts.h>
#include <varifold/measure/surface_counts.h>
#include <varifold/mesh/topology.h>
#include <varifold/models/patch_tree/extract.h>
#include <algorithm>
#include <numeric>
#include <set>
#include <span>
#include <string>

namespace varifold::test {
namespace {

std::set<std::string> faults_of(const PatchTreeData& data, std::uint32_t fronts) {
  ModelCheckOptions options;
  options.fronts = fronts;
  const auto check = check_patch_tree(std::make_shared<const PatchTree>(data), options);
  EXPECT_TRUE(check);
  std::set<std::string> kinds;
  for (const Fault& fault : check->faults)
    if (fault.severity != Severity::kNote) kinds.insert(fault.kind);
  return kinds;
}

TEST(SurfaceCounts, AreThoseOfTheTopology) {
  for (const NamedMesh& named : all_groups()) {
    SCOPED_TRACE(named.name);
    const check::SurfaceCounts counts = check::count_surface(named.mesh);
    const TopologyReport topology =
        analyze_topology(named.mesh, weld_exact(named.mesh.positions), 1);
    EXPECT_EQ(counts.boundary_edges, topology.boundary_edges);
    EXPECT_EQ(counts.nonmanifold_edges, topology.nonmanifold_edges);
    EXPECT_EQ(counts.misoriented_edges, topology.misoriented_edges);
    EXPECT_EQ(counts.duplicate_triangles, topology.duplicate_triangles);
    EXPECT_EQ(counts.degenerate_triangles, topology.degenerate_triangles);
    EXPECT_EQ(counts.euler_of_component.size(), topology.components);
    EXPECT_EQ(std::accumulate(counts.euler_of_component.begin(), counts.euler_of_component.end(),
                              std::int64_t{0}),
              topology.euler_characteristic);
  }
}

TEST(LegalFronts, AreLegalAndOfAllSorts) {
  const PatchTopology& t = built_tree("blob of patches of 40").tree->topology();
  std::set<std::uint64_t> different;
  for (std::uint32_t number = 0; number < 60; ++number) {
    const check::LegalFront front = check::legal_front(t, number);
    EXPECT_TRUE(is_legal(t, front.is_split)) << front.name;
    EXPECT_EQ(front.is_split, check::legal_front(t, number).is_split);
    different.insert(checksum(std::as_bytes(std::span(front.is_split))));
  }
  EXPECT_GT(different.size(), 45u);
}

TEST(CheckPatchTree, AllGroupsAreSound) {
  std::uint64_t collapsed = 0;
  std::uint32_t fronts = 0;
  for (const BuiltTree& built : built_trees()) {
    SCOPED_TRACE(built.name);
    ModelCheckOptions options;
    options.fronts = 60;
    const auto check = check_patch_tree(built.tree, options);
    ASSERT_TRUE(check);
    for (const Fault& fault : check->faults)
      EXPECT_EQ(fault.severity, Severity::kNote)
          << fault.kind << " " << fault.count << " at " << fault.where;
    collapsed += check->collapsed_triangles;
    fronts += check->fronts_checked;
  }
  EXPECT_GT(collapsed, 1000u);
  EXPECT_GT(fronts, 1000u);
}

class BrokenPatchTree : public ::testing::Test {
 protected:
  PatchTreeData data_ = built_tree("blob of patches of 40").tree->data();
  // A leaf with vertices that move somewhere.
  void SetUp() override {
    const PatchTopology& t = data_.topology;
    for (std::uint32_t node = t.first_of_level[t.level_count() - 1]; node < t.node_count(); ++node)
      for (std::uint32_t v = data_.offsets[node].vertex;
           v < data_.offsets[node].vertex + data_.offsets[node + 1].controller -
                   data_.offsets[node].controller;
           ++v) {
        node_ = node;
        vertex_ = v;
        controller_ = data_.offsets[node].controller + v - data_.offsets[node].vertex;
        return;
      }
    FAIL();
  }
  std::uint32_t node_ = 0, vertex_ = 0, controller_ = 0;
};

TEST_F(BrokenPatchTree, IsNoneYet) { EXPECT_TRUE(faults_of(data_, 100).empty()); }

// A crack where the patch on the other side moves it elsewhere.
TEST_F(BrokenPatchTree, ASurvivorOfOnePatchAlone) {
  data_.survivors[vertex_] = data_.survivors[vertex_] == 0 ? 1 : 0;
  const auto kinds = faults_of(data_, 400);
  EXPECT_EQ(kinds.count("survivors_differ"), 1u);
  EXPECT_EQ(kinds.count("front_open_edge"), 1u);
}

TEST_F(BrokenPatchTree, AControllerThatIsNotOnTheOtherSide) {
  const auto neighbors = data_.topology.neighbors_of(data_.topology.parent[node_]);
  ASSERT_GT(neighbors.size(), 1u);
  data_.controllers[controller_] = data_.controllers[controller_] == 0 ? 1 : 0;
  const auto kinds = faults_of(data_, 400);
  EXPECT_EQ(kinds.count("wrong_controller"), 1u);
  EXPECT_EQ(kinds.count("front_open_edge"), 1u);
}

TEST_F(BrokenPatchTree, AVertexElsewhere) {
  data_.vertices.positions[vertex_] += Vec3(0.01f);
  const auto kinds = faults_of(data_, 40);
  EXPECT_EQ(kinds.count("open_edge"), 0u) << "the finest level is what others are compared to";
  EXPECT_EQ(kinds.count("wrong_controller"), 1u);
}

TEST_F(BrokenPatchTree, ATriangleTheOtherWayRound) {
  // Of an inner node, so that the finest level does not have it, that does not look everywhere.
  std::size_t node = 1;
  while (data_.bounds[node].cone.is_wide()) ++node;
  ASSERT_FALSE(data_.topology.is_leaf(static_cast<std::uint32_t>(node)));
  const std::size_t t = data_.offsets[node].triangle;
  std::swap(data_.corners[3 * t], data_.corners[3 * t + 1]);
  const auto kinds = faults_of(data_, 40);
  EXPECT_EQ(kinds.count("new_misoriented_edge"), 1u);
}

TEST_F(BrokenPatchTree, ATriangleTwice) {
  const std::size_t t = data_.offsets[1].triangle;
  for (std::size_t k = 0; k < 3; ++k) data_.corners[3 * t + 3 + k] = data_.corners[3 * t + k];
  const auto kinds = faults_of(data_, 40);
  EXPECT_EQ(kinds.count("new_duplicate_triangle"), 1u);
  EXPECT_EQ(kinds.count("open_edge"), 1u);
}

// Leaves: nobody moves by those of theirs.
TEST_F(BrokenPatchTree, ANeighborThatIsNotThere) {
  PatchTopology& t = data_.topology;
  const std::uint32_t at = t.first_neighbor[node_];
  ASSERT_GT(t.first_neighbor[node_ + 1] - at, 1u);
  t.neighbors[at] = t.neighbors[at + 1];
  EXPECT_EQ(faults_of(data_, 0).count("neighbor_missing"), 1u);
}

TEST_F(BrokenPatchTree, BoundsTooSmall) {
  data_.bounds[node_].ball.radius *= 0.5f;
  data_.bounds[node_].cone = {Vec3(0, 0, 1), 0.999f, 0.0447f};
  const auto kinds = faults_of(data_, 0);
  EXPECT_EQ(kinds.count("outside_ball"), 1u);
  EXPECT_EQ(kinds.count("outside_cone"), 1u);
}

// A survivor that both sides agree upon, but that turns a triangle between.
TEST_F(BrokenPatchTree, ASwitchThatTurnsATriangle) {
  const PatchTree good(data_);
  const std::uint32_t parent = data_.topology.parent[node_];
  const Vec3 place = data_.vertices.positions[vertex_];
  const Vec3 before =
      data_.vertices.positions[data_.offsets[parent].vertex + data_.survivors[vertex_]];
  // To the far end of the parent's patch, in all patches that have the point.
  Vec3 farthest = place;
  for (std::uint32_t v = data_.offsets[parent].vertex; v < data_.offsets[parent + 1].vertex; ++v)
    if (glm::length(data_.vertices.positions[v] - place) > glm::length(farthest - place))
      farthest = data_.vertices.positions[v];
  ASSERT_NE(before, farthest);
  data_.survivors[vertex_] = [&] {
    for (std::uint32_t v = data_.offsets[parent].vertex;; ++v)
      if (data_.vertices.positions[v] == farthest)
        return static_cast<std::uint16_t>(v - data_.offsets[parent].vertex);
  }();
  EXPECT_EQ(faults_of(data_, 0).count("turned_triangle"), 1u);
}

TEST(CheckPatchTree, CanBeCancelled) {
  ModelCheckOptions options;
  int calls = 0;
  options.progress = [&calls](std::string_view, float) { return ++calls < 5; };
  const auto check = check_patch_tree(built_tree("blob of patches of 40").tree, options);
  ASSERT_FALSE(check);
  EXPECT_EQ(check.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace varifold::test
