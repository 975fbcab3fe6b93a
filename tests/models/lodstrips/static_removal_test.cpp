#include <gtest/gtest.h>
#include <tests/models/lodstrips/static_support.h>
#include <tests/strip/oriented_triangles.h>
#include <varifold/models/lodstrips/static_removal.h>
#include <algorithm>
#include <span>
#include <vector>

namespace varifold {
namespace {

std::vector<test::OrientedTriangle> triangles_of_strip(std::span<const std::uint32_t> strip) {
  std::vector<test::OrientedTriangle> triangles;
  for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
    const auto corners = strip_triangle(strip, i);
    if (!is_degenerate(corners))
      triangles.push_back(test::oriented(corners[0], corners[1], corners[2], 0));
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// A mesh of the given strip, in which vertex v of `from` goes to `to` in one step. Vertices are
// their own numbers; the last one moves.
std::vector<std::uint32_t> after_one_collapse(const std::vector<std::uint32_t>& strip,
                                              std::uint32_t to) {
  DetailedMesh detailed;
  const std::uint32_t moved = *std::max_element(strip.begin(), strip.end());
  detailed.mesh.positions.resize(moved + 1);
  detailed.sequence.target.assign(moved + 1, kNone);
  detailed.sequence.target[moved] = to;
  detailed.sequence.vertices = {moved, moved + 1};
  detailed.sequence.triangles = {0, 0};
  detailed.sequence.error = {0, 0};
  TriangleStrips strips;
  strips.indices = strip;
  strips.end_strip(0);
  StaticRemoval removal(detailed, strips);
  (void)removal.collapse();
  const auto& left = removal.slots().indices();
  std::vector<std::uint32_t> result(left.begin(), left.begin() + removal.slots().length(0));
  // Whatever went, the triangles are those of the strip with the vertex replaced.
  std::vector<std::uint32_t> replaced = strip;
  std::replace(replaced.begin(), replaced.end(), moved, to);
  EXPECT_EQ(triangles_of_strip(result), triangles_of_strip(replaced));
  return result;
}

using Strip = std::vector<std::uint32_t>;

TEST(StaticRemoval, RunsLosePairsAndKeepTheirParity) {
  // The thesis' own example makes three equal indices two, which would turn (8 9 10) round.
  EXPECT_EQ(after_one_collapse({6, 5, 4, 7, 8, 11, 8, 9, 10}, 8),
            (Strip{6, 5, 4, 7, 8, 8, 8, 9, 10}));
  // aaaa -> aa and aaaaa -> aaa
  EXPECT_EQ(after_one_collapse({1, 2, 3, 4, 10, 4, 10, 5, 6}, 4), (Strip{1, 2, 3, 4, 4, 5, 6}));
  EXPECT_EQ(after_one_collapse({1, 2, 3, 4, 10, 4, 10, 4, 5, 6}, 4),
            (Strip{1, 2, 3, 4, 4, 4, 5, 6}));
}

TEST(StaticRemoval, AlternationsLosePairs) {
  // abab -> ab
  EXPECT_EQ(after_one_collapse({1, 2, 3, 4, 3, 10, 5, 6}, 4), (Strip{1, 2, 3, 4, 5, 6}));
  // aabaa -> aaa
  EXPECT_EQ(after_one_collapse({1, 2, 4, 4, 3, 10, 4, 5, 6}, 4), (Strip{1, 2, 4, 4, 4, 5, 6}));
}

TEST(StaticRemoval, EndsAreTrimmed) {
  EXPECT_EQ(after_one_collapse({1, 2, 3, 4, 10}, 4), (Strip{1, 2, 3, 4}));
  EXPECT_EQ(after_one_collapse({10, 3, 4, 3, 5, 6}, 4), (Strip{4, 3, 5, 6}));
  EXPECT_LT(after_one_collapse({1, 10, 2}, 2).size(), 3u);
}

TEST(StaticRemoval, CutsKeepAllTriangles) {
  for (const test::NamedSequence& sequence : test::all_sequences()) {
    const TriangleStrips strips = stripify(sequence.detailed.mesh);
    for (const std::uint32_t most : {4u, 5u, 1000u}) {
      const TriangleStrips cut = cut_for_removal(sequence.detailed, strips, most);
      auto expected = triangles_of(strips), found = triangles_of(cut);
      TriangleMesh a, b;
      a.indices = std::move(expected);
      b.indices = std::move(found);
      EXPECT_EQ(test::oriented_triangles(a), test::oriented_triangles(b)) << sequence.name;
      for (std::uint32_t s = 0; s < cut.count(); ++s) {
        EXPECT_GE(cut.strip(s).size(), 3u);
        EXPECT_LE(cut.strip(s).size(), most);
      }
    }
  }
}

}  // namespace
}  // namespace varifold
