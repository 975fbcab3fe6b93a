// A forest as nested ranges: what belongs to a subtree stands in one row.
#pragma once

#include <varifold/base/math.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Elements [begin, begin + count).
struct NestedRange {
  std::uint32_t begin = 0;
  std::uint32_t count = 0;
};

/// Per node of a forest (parent[v] < v, or kNone) a range with room for its own elements and those
/// of its subtree: first its own, then its children's, the child of the greatest number first.
/// `own` has a count per node, and nodes without a parent follow one another. O(nodes).
[[nodiscard]] inline std::vector<NestedRange> nested_ranges(std::span<const std::uint32_t> parent,
                                                            std::span<const std::uint32_t> own) {
  std::vector<NestedRange> ranges(parent.size());
  for (std::size_t v = parent.size(); v-- > 0;) {
    ranges[v].count += own[v];
    if (parent[v] != kNone) ranges[parent[v]].count += ranges[v].count;
  }
  // Children take their places from the end of what is left of their parent's range.
  std::vector<std::uint32_t> left(parent.size());
  std::uint32_t end = 0;
  for (std::size_t v = 0; v < parent.size(); ++v) {
    if (parent[v] == kNone) {
      ranges[v].begin = end;
      end += ranges[v].count;
    } else {
      left[parent[v]] -= ranges[v].count;
      ranges[v].begin = left[parent[v]];
    }
    left[v] = ranges[v].begin + ranges[v].count;
  }
  return ranges;
}

}  // namespace varifold
