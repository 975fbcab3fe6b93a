#include <gtest/gtest.h>
#include <varifold/base/random.h>
#include <varifold/models/lodstrips/strip_ranges.h>
#include <array>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace varifold {
namespace {

using Entry = std::array<std::uint32_t, 3>;  // first index, count, material

std::vector<Entry> entries_of(const StripRanges& ranges) {
  std::vector<Entry> entries;
  for (const DrawRange& range : ranges.ranges())
    entries.push_back({range.first_index, range.index_count, range.material});
  return entries;
}

struct Strips {
  TriangleStrips strips;
  TriangleMesh attributes;  // materials 7, 6, ...: not those of their places
};

// Some material ranges may be left without strips.
Strips some_strips(std::uint32_t range_count, Random& random) {
  Strips made;
  for (std::uint32_t r = 0; r < range_count; ++r) {
    made.attributes.ranges.push_back({7 - r, 0, 0});
    for (std::uint32_t s = random.below(5); s > 0; --s) {
      made.strips.indices.resize(made.strips.indices.size() + 3 + random.below(9), 0);
      made.strips.end_strip(r);
    }
  }
  return made;
}

void expect_ranges(const StripRanges& ranges, const Strips& strips,
                   const std::vector<std::uint32_t>& lengths) {
  std::set<Entry> expected;
  for (std::uint32_t s = 0; s < lengths.size(); ++s)
    if (lengths[s] >= kLeastStrip)
      expected.insert({strips.strips.first[s], lengths[s], 7 - strips.strips.range[s]});
  const std::vector<Entry> entries = entries_of(ranges);
  EXPECT_EQ(std::set<Entry>(entries.begin(), entries.end()), expected);
  EXPECT_EQ(entries.size(), expected.size());
  for (std::size_t i = 1; i < entries.size(); ++i)
    EXPECT_GE(entries[i - 1][2], entries[i][2]) << "materials in the order of their ranges";
}

// Strips get shorter until none is left and longer again the same way: each is there once, beside
// those of its material, and the order on the way back is that on the way there.
TEST(StripRanges, GoAndComeBackInTheSameOrder) {
  Random random(23);
  for (std::uint32_t run = 0; run < 200; ++run) {
    const Strips strips = some_strips(1 + run % 6, random);
    const std::uint32_t count = strips.strips.count();
    StripRanges ranges(strips.strips, strips.attributes);
    std::vector<std::uint32_t> lengths(count);
    for (std::uint32_t s = 0; s < count; ++s)
      lengths[s] = strips.strips.first[s + 1] - strips.strips.first[s];
    std::vector<std::pair<std::uint32_t, std::uint32_t>> changes;  // strip, length before
    std::vector<std::vector<Entry>> on_the_way{entries_of(ranges)};
    std::set<std::uint32_t> left;
    for (std::uint32_t s = 0; s < count; ++s) left.insert(s);
    while (!left.empty()) {
      const std::uint32_t s =
          *std::next(left.begin(), random.below(static_cast<std::uint32_t>(left.size())));
      changes.emplace_back(s, lengths[s]);
      const std::uint32_t by = 1 + random.below(4);
      lengths[s] -= std::min(by, lengths[s]);
      if (lengths[s] == 0) left.erase(s);
      ranges.resize(s, changes.back().second, lengths[s]);
      expect_ranges(ranges, strips, lengths);
      on_the_way.push_back(entries_of(ranges));
    }
    EXPECT_TRUE(ranges.ranges().empty());
    while (!changes.empty()) {
      const auto [s, before] = changes.back();
      changes.pop_back();
      ranges.resize(s, lengths[s], before);
      lengths[s] = before;
      on_the_way.pop_back();
      ASSERT_EQ(entries_of(ranges), on_the_way.back());
    }
  }
}

}  // namespace
}  // namespace varifold
