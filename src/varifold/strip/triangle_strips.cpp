#include <varifold/strip/triangle_strips.h>

#include <algorithm>
#include <numeric>

namespace varifold {

namespace {

void append_joint(std::uint32_t first, StripJoin join, std::size_t range_begin,
                  std::vector<std::uint32_t>& indices) {
  if (join == StripJoin::kRestart) {
    indices.push_back(kStripRestart);
    return;
  }
  // Every strip begins at an even place, so that the first triangle keeps its orientation.
  const std::uint32_t last = indices.back();
  indices.push_back(last);
  if ((indices.size() - range_begin) % 2 == 0) indices.push_back(last);
  indices.push_back(first);
}

bool draws_a_triangle(std::span<const std::uint32_t> strip) {
  for (std::size_t i = 0; i + 2 < strip.size(); ++i)
    if (!is_degenerate(strip_triangle(strip, i))) return true;
  return false;
}

}  // namespace

JoinedStrips join_strips(const TriangleStrips& strips, const TriangleMesh& mesh, StripJoin join) {
  JoinedStrips joined;
  joined.indices.reserve(strips.indices.size() + 4 * std::size_t{strips.count()});
  const std::size_t range_count = mesh.ranges.empty() ? 1 : mesh.ranges.size();
  std::vector<std::vector<std::uint32_t>> strips_of(range_count);
  for (std::uint32_t s = 0; s < strips.count(); ++s) strips_of[strips.range[s]].push_back(s);
  for (std::size_t r = 0; r < range_count; ++r) {
    const std::size_t begin = joined.indices.size();
    for (const std::uint32_t s : strips_of[r]) {
      const auto strip = strips.strip(s);
      if (strip.empty()) continue;
      if (joined.indices.size() > begin) append_joint(strip[0], join, begin, joined.indices);
      joined.indices.insert(joined.indices.end(), strip.begin(), strip.end());
    }
    if (joined.indices.size() == begin) continue;
    joined.ranges.push_back({static_cast<std::uint32_t>(begin),
                             static_cast<std::uint32_t>(joined.indices.size() - begin),
                             Primitive::kStrips,
                             mesh.ranges.empty() ? 0 : mesh.ranges[r].material});
  }
  return joined;
}

TriangleStrips strips_of(std::span<const std::uint32_t> indices,
                         std::span<const DrawRange> ranges) {
  TriangleStrips strips;
  strips.indices.reserve(indices.size());
  for (const DrawRange& range : ranges) {
    if (range.primitive != Primitive::kStrips) continue;
    const auto drawn = indices.subspan(range.first_index, range.index_count);
    for (auto begin = drawn.begin(); begin != drawn.end();) {
      const auto end = std::find(begin, drawn.end(), kStripRestart);
      if (draws_a_triangle({begin, end})) {
        strips.indices.insert(strips.indices.end(), begin, end);
        strips.end_strip(range.material);
      }
      begin = end == drawn.end() ? end : end + 1;
    }
  }
  return strips;
}

std::vector<std::uint32_t> triangles_of(const TriangleStrips& strips) {
  std::vector<std::uint32_t> indices;
  std::uint32_t range_count = 0;
  for (const std::uint32_t r : strips.range) range_count = r >= range_count ? r + 1 : range_count;
  for (std::uint32_t r = 0; r < range_count; ++r) {
    for (std::uint32_t s = 0; s < strips.count(); ++s) {
      if (strips.range[s] != r) continue;
      const auto strip = strips.strip(s);
      for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
        const auto corners = strip_triangle(strip, i);
        if (!is_degenerate(corners)) indices.insert(indices.end(), corners.begin(), corners.end());
      }
    }
  }
  return indices;
}

TriangleStrips sorted_by_range(const TriangleStrips& strips) {
  if (std::is_sorted(strips.range.begin(), strips.range.end())) return strips;
  std::vector<std::uint32_t> order(strips.count());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return strips.range[a] < strips.range[b];
  });
  TriangleStrips sorted;
  sorted.indices.reserve(strips.indices.size());
  for (const std::uint32_t s : order) {
    const auto strip = strips.strip(s);
    sorted.indices.insert(sorted.indices.end(), strip.begin(), strip.end());
    sorted.end_strip(strips.range[s]);
  }
  return sorted;
}

}  // namespace varifold
