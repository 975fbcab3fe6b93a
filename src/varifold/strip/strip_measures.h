// How good strips, or any index buffers, are: indices a triangle, swaps, vertex cache misses.
#pragma once

#include <varifold/strip/triangle_strips.h>
#include <varifold/view/draw_list.h>
#include <cstdint>
#include <span>

namespace varifold {

/// Counts over all ranges of an index buffer.
struct IndexMeasures {
  std::uint64_t strips = 0;     ///< divided by kStripRestart or by ranges
  std::uint64_t indices = 0;    ///< restarts included
  std::uint64_t triangles = 0;  ///< those that are not degenerate
  std::uint64_t swaps = 0;      ///< degenerate triangles inside strips; also those that join strips

  [[nodiscard]] double indices_per_triangle() const {
    return triangles == 0 ? 0 : static_cast<double>(indices) / static_cast<double>(triangles);
  }
};

/// O(indices). A restart between two ranges is not counted: what is counted is what is drawn.
[[nodiscard]] IndexMeasures measure_indices(std::span<const std::uint32_t> indices,
                                            std::span<const DrawRange> ranges);

/// The strips as they are, one restart between every two of them counted. O(indices).
[[nodiscard]] IndexMeasures measure_strips(const TriangleStrips& strips);

/// What a first-in first-out cache of transformed vertices makes of an index buffer.
struct CacheMeasures {
  std::uint64_t misses = 0;
  std::uint64_t triangles = 0;  ///< those that are not degenerate
  std::uint64_t vertices = 0;   ///< different ones used

  /// Average cache miss ratio: vertices transformed per triangle; 0.5 is the best for large closed
  /// meshes, 3 the worst for lists.
  [[nodiscard]] double acmr() const {
    return triangles == 0 ? 0 : static_cast<double>(misses) / static_cast<double>(triangles);
  }
  /// Average transformed vertex ratio: how often a vertex is transformed; 1 is the best.
  [[nodiscard]] double atvr() const {
    return vertices == 0 ? 0 : static_cast<double>(misses) / static_cast<double>(vertices);
  }
};

/// The ranges drawn one after the other through one cache of `cache_size` > 0 entries.
/// O(indices + greatest index).
[[nodiscard]] CacheMeasures measure_cache(std::span<const std::uint32_t> indices,
                                          std::span<const DrawRange> ranges,
                                          std::uint32_t cache_size);
[[nodiscard]] CacheMeasures measure_cache(const TriangleStrips& strips, std::uint32_t cache_size);

}  // namespace varifold
