// Based on: [Hoppe1999b] section 3 (the average cache miss ratio of a FIFO vertex cache).
#include <varifold/strip/fifo_cache.h>
#include <varifold/strip/strip_measures.h>
#include <algorithm>
#include <array>
#include <vector>

namespace varifold {

namespace {

bool differ(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  return a != b && b != c && c != a;
}

void measure_list(std::span<const std::uint32_t> indices, IndexMeasures& measures) {
  measures.indices += indices.size();
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    if (differ(indices[i], indices[i + 1], indices[i + 2])) ++measures.triangles;
}

// One strip, without restarts.
void measure_strip(std::span<const std::uint32_t> strip, IndexMeasures& measures) {
  if (strip.empty()) return;
  ++measures.strips;
  for (std::size_t i = 0; i + 2 < strip.size(); ++i)
    ++(differ(strip[i], strip[i + 1], strip[i + 2]) ? measures.triangles : measures.swaps);
}

void measure_range(std::span<const std::uint32_t> indices, IndexMeasures& measures) {
  measures.indices += indices.size();
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= indices.size(); ++i) {
    if (i < indices.size() && indices[i] != kStripRestart) continue;
    measure_strip(indices.subspan(begin, i - begin), measures);
    begin = i + 1;
  }
}

std::uint32_t greatest(std::span<const std::uint32_t> indices) {
  std::uint32_t most = 0;
  for (const std::uint32_t index : indices)
    if (index != kStripRestart) most = std::max(most, index);
  return most;
}

}  // namespace

IndexMeasures measure_indices(std::span<const std::uint32_t> indices,
                              std::span<const DrawRange> ranges) {
  IndexMeasures measures;
  for (const DrawRange& range : ranges) {
    const auto drawn = indices.subspan(range.first_index, range.index_count);
    if (range.primitive == Primitive::kTriangles)
      measure_list(drawn, measures);
    else
      measure_range(drawn, measures);
  }
  return measures;
}

IndexMeasures measure_strips(const TriangleStrips& strips) {
  IndexMeasures measures;
  for (std::uint32_t s = 0; s < strips.count(); ++s) measure_strip(strips.strip(s), measures);
  measures.indices = strips.indices.size();
  if (measures.strips > 0) measures.indices += measures.strips - 1;
  return measures;
}

CacheMeasures measure_cache(std::span<const std::uint32_t> indices,
                            std::span<const DrawRange> ranges, std::uint32_t cache_size) {
  CacheMeasures measures;
  measures.triangles = measure_indices(indices, ranges).triangles;
  FifoCache cache(greatest(indices) + 1, cache_size);
  for (const DrawRange& range : ranges) {
    for (const std::uint32_t index : indices.subspan(range.first_index, range.index_count)) {
      if (index == kStripRestart) continue;
      if (!cache.was_used(index)) ++measures.vertices;
      cache.use(index);
    }
  }
  measures.misses = cache.misses();
  return measures;
}

CacheMeasures measure_cache(const TriangleStrips& strips, std::uint32_t cache_size) {
  std::vector<DrawRange> ranges;
  for (std::uint32_t s = 0; s < strips.count(); ++s)
    ranges.push_back({strips.first[s], strips.first[s + 1] - strips.first[s], Primitive::kStrips});
  return measure_cache(strips.indices, ranges, cache_size);
}

}  // namespace varifold
