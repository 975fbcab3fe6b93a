#include <varifold/simplify/rings.h>

#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <varifold/simplify/working_surface.h>
#include <algorithm>

namespace varifold {
namespace {

std::vector<RingEntry> ordered(std::vector<LinkEdge> edges, bool expect_closed) {
  std::vector<RingEntry> ring;
  EXPECT_EQ(order_ring(edges, ring), expect_closed);
  return ring;
}

TEST(OrderRing, ClosesARing) {
  const auto ring = ordered({{2, 3, 12}, {1, 2, 11}, {3, 1, 13}}, true);
  ASSERT_EQ(ring.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(ring[i].face, 10 + ring[i].neighbor);
    EXPECT_EQ(ring[(i + 1) % 3].neighbor, ring[i].neighbor % 3 + 1);
  }
}

TEST(OrderRing, EndsAFanWithAGap) {
  const auto ring = ordered({{2, 3, 12}, {1, 2, 11}}, false);
  ASSERT_EQ(ring.size(), 3u);
  EXPECT_EQ(ring[0].neighbor, 1u);
  EXPECT_EQ(ring[1].neighbor, 2u);
  EXPECT_EQ(ring[2].neighbor, 3u);
  EXPECT_EQ(ring[2].face, kNone);
}

TEST(OrderRing, RepeatsTheFirstNeighbourOfAClosedFanBesideOthers) {
  const auto ring =
      ordered({{1, 2, 11}, {2, 3, 12}, {3, 1, 13}, {7, 8, 17}, {8, 9, 18}, {9, 7, 19}}, false);
  ASSERT_EQ(ring.size(), 8u);
  EXPECT_EQ(ring[0].neighbor, ring[3].neighbor);
  EXPECT_EQ(ring[3].face, kNone);
  EXPECT_EQ(ring[4].neighbor, ring[7].neighbor);
  EXPECT_EQ(ring[7].face, kNone);
}

TEST(OrderRing, BreaksWhereSheetsMeet) {
  // Three faces at the edge to neighbour 1.
  const auto ring = ordered({{1, 2, 12}, {1, 3, 13}, {4, 1, 41}}, false);
  EXPECT_EQ(std::count_if(ring.begin(), ring.end(), [](auto e) { return e.face == kNone; }), 3);
}

TEST(Rings, SpeakOfTheFacesOfEveryMesh) {
  for (const test::NamedMesh& named : test::all_groups()) {
    SCOPED_TRACE(named.name);
    InputFaults faults;
    WorkingSurface surface = build_surface(named.mesh, {}, faults);
    std::size_t corners = 0;
    for (std::uint32_t p = 0; p < surface.point_count(); ++p) {
      std::vector<LinkEdge> edges;
      link_edges(surface.ring_span(p), edges);
      corners += edges.size();
      for (const LinkEdge& edge : edges) {
        // The face has these three points as its corners, in this order.
        const std::uint32_t* v = &named.mesh.indices[3 * std::size_t{edge.face}];
        std::uint32_t at = 0;
        while (at < 3 && surface.point_of_vertex[v[at]] != p) ++at;
        ASSERT_LT(at, 3u);
        EXPECT_EQ(surface.point_of_vertex[v[(at + 1) % 3]], edge.from);
        EXPECT_EQ(surface.point_of_vertex[v[(at + 2) % 3]], edge.to);
      }
    }
    EXPECT_EQ(corners, 3 * std::size_t{surface.face_count});
    EXPECT_EQ(surface.face_count + faults.degenerate_triangles + faults.duplicate_triangles,
              named.mesh.triangle_count());
  }
}

TEST(RingPool, ReusesWhatWasReleased) {
  RingPool pool;
  const std::uint32_t a = pool.allocate(9);
  const std::uint32_t b = pool.allocate(20);
  EXPECT_EQ(a % 16, 0u);
  EXPECT_GE(b, a + 16);
  pool.release(a, 9);
  EXPECT_EQ(pool.allocate(16), a);
  EXPECT_NE(pool.allocate(16), a);
}

}  // namespace
}  // namespace varifold
