#include <gtest/gtest.h>

#include <tests/support/meshes.h>
#include <varifold/mesh/topology.h>
#include <algorithm>
#include <map>
#include <set>

namespace varifold {
namespace {

using test::NamedMesh;

TopologyReport analyze(const TriangleMesh& mesh, int threads = 0) {
  return analyze_topology(mesh, weld_exact(mesh.positions), threads);
}

TEST(VertexFaces, RowsAreAscendingAndDegeneratesStandOnce) {
  // 0 and 3 are one place; triangle 1 has it twice.
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  const std::vector<std::uint32_t> indices{0, 1, 2, 3, 0, 2, 2, 1, 3};
  const VertexFaces faces(indices, weld_exact(positions));
  ASSERT_EQ(faces.class_count(), 3u);
  const auto row = [&](std::uint32_t c) {
    const auto span = faces.triangles_of(c);
    return std::vector<std::uint32_t>(span.begin(), span.end());
  };
  EXPECT_EQ(row(0), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(row(1), (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(row(2), (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(Topology, NothingOfNothing) {
  const TopologyReport report = analyze({});
  EXPECT_EQ(report.triangles, 0u);
  EXPECT_EQ(report.components, 0u);
  EXPECT_EQ(report.euler_characteristic, 0);
  EXPECT_FALSE(report.closed);
  EXPECT_FALSE(report.genus());
}

TEST(Topology, OneTriangle) {
  const TopologyReport report =
      analyze(test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}));
  EXPECT_EQ(report.edges, 3u);
  EXPECT_EQ(report.boundary_edges, 3u);
  EXPECT_EQ(report.boundary_loops, 1u);
  EXPECT_EQ(report.euler_characteristic, 1);
  EXPECT_EQ(report.components, 1u);
  EXPECT_TRUE(report.manifold());
}

TEST(Topology, ClosedGroupIsClosed) {
  const std::map<std::string, std::int64_t> genus{{"sponge_genus_5", 5}, {"sponge_genus_81", 81}};
  for (const auto& [name, mesh] : test::group_closed()) {
    SCOPED_TRACE(name);
    const TopologyReport report = analyze(mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.manifold());
    EXPECT_TRUE(report.oriented());
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.boundary_loops, 0u);
    ASSERT_TRUE(report.genus());
    EXPECT_EQ(*report.genus(), genus.count(name) != 0 ? genus.at(name) : 0);
  }
}

TEST(Topology, OpenGroupHasLoops) {
  const std::map<std::string, std::uint32_t> loops{
      {"punched_grid", 2}, {"ring", 2}, {"planet_without_poles", 2}};
  for (const auto& [name, mesh] : test::group_open()) {
    SCOPED_TRACE(name);
    const TopologyReport report = analyze(mesh);
    EXPECT_FALSE(report.closed);
    EXPECT_TRUE(report.manifold());
    EXPECT_TRUE(report.oriented());
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.boundary_loops, loops.count(name) != 0 ? loops.at(name) : 1);
    EXPECT_FALSE(report.genus());
  }
}

TEST(Topology, NonmanifoldGroup) {
  for (const auto& [name, mesh] : test::group_nonmanifold()) {
    SCOPED_TRACE(name);
    const TopologyReport report = analyze(mesh);
    EXPECT_FALSE(report.manifold());
    EXPECT_GT(report.nonmanifold_vertices, 0u);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.nonmanifold_edges == 0, name == "shared_vertex");
  }
}

TEST(Topology, SeamsAreNoBoundaries) {
  for (const auto& [name, mesh] : test::group_seams()) {
    SCOPED_TRACE(name);
    const TopologyReport report = analyze(mesh);
    EXPECT_LT(report.classes, report.vertices);
    EXPECT_TRUE(report.manifold());
    EXPECT_TRUE(report.oriented());
    EXPECT_EQ(report.closed, name != "patchwork");
  }
}

TEST(Topology, CountsComponents) {
  std::vector<std::uint32_t> counts;
  for (const auto& named : test::group_components())
    counts.push_back(analyze(named.mesh).components);
  EXPECT_EQ(counts, (std::vector<std::uint32_t>{12, 12, 2, 4}));
}

TEST(Topology, LoopsFollowTheFans) {
  // A 4 x 4 grid without the squares (1,1) and (2,2), which meet at vertex (2,2).
  TriangleMesh mesh = test::grid(4, 4);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t square = 0; square < 16; ++square)
    if (square != 5 && square != 10)
      kept.insert(kept.end(), mesh.indices.begin() + 6 * square,
                  mesh.indices.begin() + 6 * square + 6);
  mesh.indices = kept;
  const TopologyReport report = analyze(mesh);
  EXPECT_EQ(report.nonmanifold_vertices, 1u);
  EXPECT_EQ(report.boundary_edges, 16u + 4u + 4u);
  EXPECT_EQ(report.boundary_loops, 2u);  // the outer one, and one around both holes
}

TEST(Topology, MoebiusStripIsOneSided) {
  for (const auto& [name, mesh] : test::group_defects()) {
    if (name != "moebius_strip") continue;
    const TopologyReport report = analyze(mesh);
    EXPECT_EQ(report.misoriented_edges, 1u);
    EXPECT_EQ(report.boundary_loops, 1u);
    EXPECT_EQ(report.euler_characteristic, 0);
    EXPECT_TRUE(report.manifold());
  }
}

TEST(Topology, Defects) {
  std::map<std::string, TopologyReport> reports;
  for (const auto& [name, mesh] : test::group_defects()) reports[name] = analyze(mesh);
  EXPECT_EQ(reports["unused_vertices"].classes - reports["unused_vertices"].used_classes, 3u);
  EXPECT_EQ(reports["unused_vertices"].components, 1u);
  EXPECT_EQ(reports["duplicates"].duplicate_triangles, 3u);
  EXPECT_EQ(reports["repeated_corners"].degenerate_triangles, 2u);
  EXPECT_EQ(reports["repeated_corners"].triangles, 18u);
  EXPECT_EQ(reports["collapsed_by_position"].degenerate_triangles, 2u);
  EXPECT_EQ(reports["one_triangle_turned"].misoriented_edges, 3u);
}

/// Edges by brute force over sets.
TEST(Topology, AgreesWithBruteForceOnAllGroups) {
  for (const auto& [name, mesh] : test::all_groups()) {
    SCOPED_TRACE(name);
    const WeldMap weld = weld_exact(mesh.positions);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> edges;
    std::set<std::array<std::uint32_t, 3>> seen;
    std::set<std::uint32_t> used;
    std::uint32_t degenerate = 0, duplicate = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      std::array<std::uint32_t, 3> t{};
      for (std::size_t k = 0; k < 3; ++k) t[k] = weld.class_of[mesh.indices[i + k]];
      if (t[0] == t[1] || t[1] == t[2] || t[0] == t[2]) {
        ++degenerate;
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        auto& edge = edges[std::minmax(t[k], t[(k + 1) % 3])];
        ++(t[k] < t[(k + 1) % 3] ? edge.first : edge.second);
        used.insert(t[k]);
      }
      std::sort(t.begin(), t.end());
      if (!seen.insert(t).second) ++duplicate;
    }
    std::uint64_t boundary = 0, nonmanifold = 0, misoriented = 0;
    for (const auto& [key, count] : edges) {
      boundary += count.first + count.second == 1;
      nonmanifold += count.first + count.second > 2;
      misoriented += count.first + count.second == 2 && count.first != 1;
    }
    const TopologyReport report = analyze(mesh);
    EXPECT_EQ(report.edges, edges.size());
    EXPECT_EQ(report.boundary_edges, boundary);
    EXPECT_EQ(report.nonmanifold_edges, nonmanifold);
    EXPECT_EQ(report.misoriented_edges, misoriented);
    EXPECT_EQ(report.degenerate_triangles, degenerate);
    EXPECT_EQ(report.duplicate_triangles, duplicate);
    EXPECT_EQ(report.used_classes, used.size());
  }
}

TEST(Topology, DoesNotDependOnThreads) {
  const TriangleMesh mesh = test::soup(50'000, 150'000, 4);
  const TopologyReport one = analyze(mesh, 1);
  for (const int threads : {2, 3}) {
    const TopologyReport many = analyze(mesh, threads);
    EXPECT_EQ(one.edges, many.edges);
    EXPECT_EQ(one.boundary_loops, many.boundary_loops);
    EXPECT_EQ(one.nonmanifold_vertices, many.nonmanifold_vertices);
    EXPECT_EQ(one.duplicate_triangles, many.duplicate_triangles);
  }
}

}  // namespace
}  // namespace varifold
