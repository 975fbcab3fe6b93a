// DrawList: what a model gives to whatever draws it: render/, a game engine, the web.
#pragma once

#include <varifold/mesh/pose.h>
#include <cstdint>
#include <span>

namespace varifold {

/// Ends a strip inside an index buffer and begins the next one.
inline constexpr std::uint32_t kStripRestart = kNone;

enum class Primitive : std::uint8_t {
  kTriangles,  ///< three indices a triangle
  kStrips,     ///< triangle strips, divided by kStripRestart
};

/// Part of the index buffer that is drawn in one go; may be empty.
struct DrawRange {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
  Primitive primitive = Primitive::kTriangles;
  std::uint32_t material = 0;
  /// Where the range stands between the coarsest (0) and the finest level (1), times that of the
  /// list; only for show.
  float level = 1;
};

/// Elements [first, first + count) of a buffer.
struct ElementRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// Spans over buffers that the model or instance owns; valid until that changes.
///
/// `normals`, `texcoords`, `colors`, `skin` and the arrays of each of `poses` are empty or have one
/// entry per position. Every index is
/// kStripRestart or below the number of positions. `changed_vertices` and `changed_indices` name
/// what was written since the previous list of the same instance, in any order, overlapping or
/// not; whoever draws may upload nothing else, apart from elements beyond the previous size, which
/// are always new. A reader that saw no previous list takes everything.
struct DrawList {
  std::span<const Vec3> positions;
  std::span<const Vec3> normals;
  std::span<const Vec2> texcoords;
  std::span<const Color> colors;
  std::span<const JointWeights> skin;
  std::span<const Pose> poses;
  std::span<const std::uint32_t> indices;
  std::span<const DrawRange> ranges;
  std::span<const ElementRange> changed_vertices;
  std::span<const ElementRange> changed_indices;
  float level = 1;  ///< of all ranges together, so that models need not touch each of them
};

/// Triangles in all ranges, the degenerate ones of strips included; O(ranges), and O(indices) for
/// strips.
[[nodiscard]] inline std::uint64_t submitted_triangles(const DrawList& list) {
  std::uint64_t triangles = 0;
  for (const DrawRange& range : list.ranges) {
    if (range.primitive == Primitive::kTriangles) {
      triangles += range.index_count / 3;
      continue;
    }
    std::uint64_t run = 0;
    for (const std::uint32_t index : list.indices.subspan(range.first_index, range.index_count)) {
      run = index == kStripRestart ? 0 : run + 1;
      if (run >= 3) ++triangles;
    }
  }
  return triangles;
}

/// What all ranges send to the device.
struct SubmittedIndices {
  std::uint64_t indices = 0;   ///< all, restarts included
  std::uint64_t vertices = 0;  ///< those that are no restarts
  std::uint64_t strips = 0;    ///< runs of these in ranges of strips
};
/// O(indices).
[[nodiscard]] inline SubmittedIndices submitted_indices(const DrawList& list) {
  SubmittedIndices sum;
  for (const DrawRange& range : list.ranges) {
    sum.indices += range.index_count;
    if (range.primitive == Primitive::kTriangles) {
      sum.vertices += range.index_count;
      continue;
    }
    bool in_strip = false;
    for (const std::uint32_t index : list.indices.subspan(range.first_index, range.index_count)) {
      const bool is_vertex = index != kStripRestart;
      sum.vertices += is_vertex ? 1 : 0;
      sum.strips += is_vertex && !in_strip ? 1 : 0;
      in_strip = is_vertex;
    }
  }
  return sum;
}

}  // namespace varifold
