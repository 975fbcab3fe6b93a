// Triangle strips over the vertices of a mesh.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/draw_list.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Strips, one after the other. Triangle i of a strip has its indices i, i + 1, i + 2, where i is
/// even counter-clockwise as they stand, where i is odd with the first two exchanged. Triangles
/// with two equal corners are degenerate: they turn the strip ("swaps") and are not drawn.
struct TriangleStrips {
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> first{0};  ///< per strip, where it begins; and the end of the last
  std::vector<std::uint32_t> range;     ///< per strip, the material range that all of it is from

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(range.size()); }
  [[nodiscard]] std::span<const std::uint32_t> strip(std::uint32_t s) const {
    return {indices.data() + first[s], first[s + 1] - first[s]};
  }
  /// Ends the strip whose indices were appended since the last call.
  void end_strip(std::uint32_t material_range) {
    first.push_back(static_cast<std::uint32_t>(indices.size()));
    range.push_back(material_range);
  }
};

/// Corners of triangle i of a strip in the order of its orientation; i + 2 < strip.size().
[[nodiscard]] inline std::array<std::uint32_t, 3> strip_triangle(
    std::span<const std::uint32_t> strip, std::size_t i) {
  return i % 2 == 0 ? std::array{strip[i], strip[i + 1], strip[i + 2]}
                    : std::array{strip[i + 1], strip[i], strip[i + 2]};
}

[[nodiscard]] inline bool is_degenerate(const std::array<std::uint32_t, 3>& corners) {
  return corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
}

/// The same strips, those of a material range beside each other in the order of the ranges.
/// O(indices).
[[nodiscard]] TriangleStrips sorted_by_range(const TriangleStrips& strips);

/// How strips become one index buffer per material.
enum class StripJoin {
  kRestart,    ///< divided by kStripRestart
  kDegenerate  ///< by repeated indices: triangles without area, an even number of indices each
};

/// An index buffer of all strips, and one range of it per material range that has strips.
struct JoinedStrips {
  std::vector<std::uint32_t> indices;
  std::vector<DrawRange> ranges;
};

/// `mesh` names the materials. No restart or repeat stands at the beginning or end of a range.
/// O(indices).
[[nodiscard]] JoinedStrips join_strips(const TriangleStrips& strips, const TriangleMesh& mesh,
                                       StripJoin join);

/// The strips that an index buffer draws, those without a triangle left out. Their `range` is the
/// material of the DrawRange. Ranges of lists are ignored. O(indices).
[[nodiscard]] TriangleStrips strips_of(std::span<const std::uint32_t> indices,
                                       std::span<const DrawRange> ranges);

/// The triangles of the strips, without the degenerate ones, in the order of the strips and of the
/// material ranges; three indices each. O(indices).
[[nodiscard]] std::vector<std::uint32_t> triangles_of(const TriangleStrips& strips);

}  // namespace varifold
