// Strips for tests of models: simple, so that they can be wrong in no interesting way.
#pragma once

#include <varifold/strip/triangle_strips.h>
#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

namespace varifold::test {

/// Every triangle once, oriented; from each that is left a strip goes on while it can, without a
/// swap, within its material range. O(n log n).
inline TriangleStrips greedy_strips(const TriangleMesh& mesh) {
  TriangleStrips strips;
  std::vector<MaterialRange> ranges = mesh.ranges;
  if (ranges.empty()) ranges.push_back({0, 0, mesh.triangle_count()});
  for (std::uint32_t r = 0; r < ranges.size(); ++r) {
    const std::uint32_t begin = ranges[r].first_triangle, end = begin + ranges[r].triangle_count;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> by_edge;
    std::vector<char> used(end - begin, 0);
    const auto corner = [&](std::uint32_t t, std::uint32_t k) {
      return mesh.indices[3 * std::size_t{t} + k % 3];
    };
    for (std::uint32_t t = begin; t < end; ++t)
      for (std::uint32_t k = 0; k < 3; ++k) by_edge[{corner(t, k), corner(t, k + 1)}].push_back(t);
    for (std::uint32_t t = begin; t < end; ++t) {
      if (used[t - begin]) continue;
      used[t - begin] = 1;
      std::array<std::uint32_t, 3> last{corner(t, 0), corner(t, 1), corner(t, 2)};
      strips.indices.insert(strips.indices.end(), last.begin(), last.end());
      for (bool odd = true;; odd = !odd) {
        const auto edge = odd ? std::pair{last[2], last[1]} : std::pair{last[1], last[2]};
        const auto& candidates = by_edge[edge];
        const auto next = std::find_if(candidates.begin(), candidates.end(),
                                       [&](std::uint32_t c) { return !used[c - begin]; });
        if (next == candidates.end()) break;
        used[*next - begin] = 1;
        std::uint32_t k = 0;
        while (corner(*next, k) != edge.first || corner(*next, k + 1) != edge.second) ++k;
        last = {last[1], last[2], corner(*next, k + 2)};
        strips.indices.push_back(last[2]);
      }
      strips.end_strip(r);
    }
  }
  return strips;
}

/// The same triangles with one strip per material range, its parts joined by degenerate triangles.
inline TriangleStrips long_strips(const TriangleMesh& mesh) {
  const TriangleStrips strips = greedy_strips(mesh);
  TriangleStrips joined;
  std::uint32_t range_count = 0;
  for (const std::uint32_t r : strips.range) range_count = std::max(range_count, r + 1);
  for (std::uint32_t r = 0; r < range_count; ++r) {
    const std::size_t begin = joined.indices.size();
    for (std::uint32_t s = 0; s < strips.count(); ++s) {
      if (strips.range[s] != r) continue;
      const auto strip = strips.strip(s);
      if (joined.indices.size() > begin) {
        joined.indices.push_back(joined.indices.back());
        if ((joined.indices.size() - begin) % 2 == 0) joined.indices.push_back(strip[0]);
        joined.indices.push_back(strip[0]);
      }
      joined.indices.insert(joined.indices.end(), strip.begin(), strip.end());
    }
    joined.end_strip(r);
  }
  return joined;
}

}  // namespace varifold::test
