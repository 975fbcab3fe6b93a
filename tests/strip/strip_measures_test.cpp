#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <varifold/base/random.h>
#include <varifold/strip/strip_measures.h>
#include <varifold/strip/stripify.h>
#include <algorithm>
#include <deque>
#include <set>
#include <vector>

namespace varifold {
namespace {

DrawRange range_of(const std::vector<std::uint32_t>& indices, Primitive primitive) {
  return {0, static_cast<std::uint32_t>(indices.size()), primitive};
}

// A cache as one would draw it: a queue.
std::uint64_t misses_by_queue(const std::vector<std::uint32_t>& indices, std::size_t size) {
  std::deque<std::uint32_t> queue;
  std::uint64_t misses = 0;
  for (const std::uint32_t index : indices) {
    if (index == kStripRestart || std::find(queue.begin(), queue.end(), index) != queue.end())
      continue;
    ++misses;
    queue.push_back(index);
    if (queue.size() > size) queue.pop_front();
  }
  return misses;
}

TEST(StripMeasures, OfAStripWithASwap) {
  // Triangles (0 1 2), then the swap (1 2 1), (2 1 3), (1 3 4).
  const std::vector<std::uint32_t> indices{0, 1, 2, 1, 3, 4};
  const DrawRange range = range_of(indices, Primitive::kStrips);
  const IndexMeasures measures = measure_indices(indices, {&range, 1});
  EXPECT_EQ(measures.strips, 1u);
  EXPECT_EQ(measures.indices, 6u);
  EXPECT_EQ(measures.triangles, 3u);
  EXPECT_EQ(measures.swaps, 1u);
  EXPECT_DOUBLE_EQ(measures.indices_per_triangle(), 2);
}

TEST(StripMeasures, OfTwoStripsWithARestart) {
  const std::vector<std::uint32_t> indices{0, 1, 2, 3, kStripRestart, 2, 3, 5};
  const DrawRange range = range_of(indices, Primitive::kStrips);
  const IndexMeasures measures = measure_indices(indices, {&range, 1});
  EXPECT_EQ(measures.strips, 2u);
  EXPECT_EQ(measures.indices, 8u);
  EXPECT_EQ(measures.triangles, 3u);
  EXPECT_EQ(measures.swaps, 0u);
  TriangleStrips strips;
  strips.indices = {0, 1, 2, 3};
  strips.end_strip(0);
  strips.indices.insert(strips.indices.end(), {2, 3, 5});
  strips.end_strip(0);
  EXPECT_EQ(measure_strips(strips).indices, 8u);
  EXPECT_EQ(measure_strips(strips).triangles, 3u);
}

TEST(StripMeasures, OfListsAndOfNothing) {
  const std::vector<std::uint32_t> indices{0, 1, 2, 2, 1, 3, 3, 3, 1};
  const DrawRange range = range_of(indices, Primitive::kTriangles);
  const IndexMeasures measures = measure_indices(indices, {&range, 1});
  EXPECT_EQ(measures.strips, 0u);
  EXPECT_EQ(measures.indices, 9u);
  EXPECT_EQ(measures.triangles, 2u);
  EXPECT_EQ(measure_indices({}, {}).indices_per_triangle(), 0);
  EXPECT_EQ(measure_cache(std::span<const std::uint32_t>{}, {}, 16).acmr(), 0);
  EXPECT_EQ(measure_cache(TriangleStrips{}, 16).atvr(), 0);
}

TEST(StripMeasures, CacheByHand) {
  // A cache of three: 0 1 2 miss, 1 hits, 3 drives out 0, 4 drives out 1, 0 and 1 miss again.
  const std::vector<std::uint32_t> indices{0, 1, 2, 2, 1, 3, 4, 0, 1};
  const DrawRange range = range_of(indices, Primitive::kTriangles);
  const CacheMeasures measures = measure_cache(indices, {&range, 1}, 3);
  EXPECT_EQ(measures.misses, 7u);
  EXPECT_EQ(measures.triangles, 3u);
  EXPECT_EQ(measures.vertices, 5u);
  EXPECT_DOUBLE_EQ(measures.acmr(), 7.0 / 3);
  EXPECT_DOUBLE_EQ(measures.atvr(), 7.0 / 5);
}

TEST(StripMeasures, CacheIsAQueue) {
  Random random(7);
  for (const std::uint32_t size : {1u, 2u, 16u, 24u, 32u}) {
    std::vector<std::uint32_t> indices(3000);
    for (std::uint32_t& index : indices) index = random.below(2 * size + 1);
    indices[100] = indices[1000] = kStripRestart;
    const DrawRange range = range_of(indices, Primitive::kStrips);
    const CacheMeasures measures = measure_cache(indices, {&range, 1}, size);
    EXPECT_EQ(measures.misses, misses_by_queue(indices, size)) << size;
    std::set<std::uint32_t> used(indices.begin(), indices.end());
    used.erase(kStripRestart);
    EXPECT_EQ(measures.vertices, used.size());
  }
}

TEST(StripMeasures, JoinsByDegeneratesAreSwaps) {
  const TriangleMesh mesh = test::icosphere(320);
  const TriangleStrips strips = stripify(mesh);
  const JoinedStrips joined = join_strips(strips, mesh, StripJoin::kDegenerate);
  const IndexMeasures measures = measure_indices(joined.indices, joined.ranges);
  EXPECT_EQ(measures.strips, 1u);
  EXPECT_EQ(measures.indices, joined.indices.size());
  EXPECT_EQ(measures.triangles, mesh.triangle_count());
  EXPECT_EQ(measures.triangles + measures.swaps + 2, joined.indices.size());
  const JoinedStrips restarted = join_strips(strips, mesh, StripJoin::kRestart);
  EXPECT_EQ(measure_indices(restarted.indices, restarted.ranges).indices,
            measure_strips(strips).indices);
}

TEST(StripsOf, RunsBetweenRestartsThatDrawATriangle) {
  const std::uint32_t r = kStripRestart;
  const std::vector<std::uint32_t> indices{9, 9, 9, 0, 1, 2, r, 3, 4, r, r, 5, 6, 5, r, 1, 2, 3, 4};
  const std::vector<DrawRange> ranges{{3, 9, Primitive::kStrips, 2},
                                      {0, 3, Primitive::kTriangles, 0},
                                      {15, 4, Primitive::kStrips, 1}};
  const TriangleStrips strips = strips_of(indices, ranges);
  ASSERT_EQ(strips.count(), 2u);
  EXPECT_EQ(strips.range, (std::vector<std::uint32_t>{2, 1}));
  EXPECT_EQ(strips.indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 2, 3, 4}));
  EXPECT_EQ(strips.first, (std::vector<std::uint32_t>{0, 3, 7}));
}

TEST(StripsOf, GivesBackWhatWasJoined) {
  for (const auto& [name, mesh] : test::all_groups()) {
    const TriangleStrips strips = stripify(mesh);
    const JoinedStrips joined = join_strips(strips, mesh, StripJoin::kRestart);
    const TriangleStrips found = strips_of(joined.indices, joined.ranges);
    // Both joins draw the same triangles.
    const JoinedStrips long_ones = join_strips(strips, mesh, StripJoin::kDegenerate);
    const TriangleStrips one = strips_of(long_ones.indices, long_ones.ranges);
    EXPECT_EQ(found.count(), strips.count()) << name;
    EXPECT_EQ(one.count(), long_ones.ranges.size()) << name;
    EXPECT_EQ(measure_strips(found).triangles, measure_strips(strips).triangles) << name;
    EXPECT_EQ(triangles_of(found).size(), triangles_of(one).size()) << name;
    if (mesh.ranges.size() < 2) {
      EXPECT_EQ(found.indices, strips.indices) << name;
      EXPECT_EQ(triangles_of(one), triangles_of(strips)) << name;
    }
  }
}

}  // namespace
}  // namespace varifold
