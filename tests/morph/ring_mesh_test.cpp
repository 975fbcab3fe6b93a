#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <varifold/mesh/topology.h>
#include <varifold/morph/ring_decimation.h>

namespace varifold {
namespace {

std::vector<std::uint32_t> triangles_of(const RingMesh& mesh) { return mesh.triangles(); }

TEST(RingMesh, EveryStepDownIsAClosedSurfaceAndUpAgainIsTheIdentity) {
  for (const TriangleMesh& mesh : {test::octahedron(), test::cube(), test::icosphere(320)}) {
    RingMesh rings(mesh.indices, mesh.vertex_count());
    const std::vector<std::uint32_t> before = triangles_of(rings);
    EXPECT_EQ(before.size(), mesh.indices.size());
    const CollapseRecord record = decimate_to_tetrahedron(rings, mesh.positions);
    ASSERT_EQ(rings.vertex_count(), 4u);
    EXPECT_EQ(record.steps.size(), mesh.vertex_count() - 4);
    for (std::size_t i = record.steps.size(); i-- > 0;) {
      TriangleMesh level;
      level.positions = mesh.positions;
      level.indices = triangles_of(rings);
      const TopologyReport report = analyze_topology(level, weld_exact(level.positions));
      ASSERT_TRUE(report.closed && report.manifold() && report.oriented());
      ASSERT_EQ(report.euler_characteristic, 2);
      ASSERT_EQ(level.triangle_count(), 2 * rings.vertex_count() - 4);
      rings.undo(record, record.steps[i]);
    }
    // Rings may begin elsewhere, which triangles() shows as a turn of the order within a vertex.
    std::vector<std::array<std::uint32_t, 3>> down, up;
    const std::vector<std::uint32_t> after = triangles_of(rings);
    for (std::size_t t = 0; t < before.size(); t += 3) {
      down.push_back({before[t], before[t + 1], before[t + 2]});
      up.push_back({after[t], after[t + 1], after[t + 2]});
    }
    std::sort(down.begin(), down.end());
    std::sort(up.begin(), up.end());
    EXPECT_EQ(down, up);
  }
}

TEST(RingMesh, ATetrahedronDoesNotCollapse) {
  const TriangleMesh mesh = test::tetrahedron();
  RingMesh rings(mesh.indices, mesh.vertex_count());
  EXPECT_FALSE(rings.can_collapse(0, 1));
}

}  // namespace
}  // namespace varifold
