// A triangulated closed surface as the rings of its vertices, which collapses record and undo.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// One collapse: `vertex` went onto ring[0]. The ring is that of the vertex before, its neighbours
/// counter-clockwise seen from outside.
struct RecordedCollapse {
  std::uint32_t vertex = 0;
  std::uint32_t first_in_ring = 0;  ///< into CollapseRecord::rings
  std::uint32_t ring_size = 0;
};

/// Collapses in the order that they were made.
struct CollapseRecord {
  std::vector<RecordedCollapse> steps;
  std::vector<std::uint32_t> rings;

  [[nodiscard]] std::span<const std::uint32_t> ring(const RecordedCollapse& step) const {
    return {rings.data() + step.first_in_ring, step.ring_size};
  }
};

/// Every vertex has the cycle of its neighbours; that is all there is, triangles follow from it.
class RingMesh {
 public:
  /// `indices` must be a closed oriented manifold over vertices that are all used. O(n).
  RingMesh(std::span<const std::uint32_t> indices, std::uint32_t vertex_count);

  [[nodiscard]] std::uint32_t vertex_count() const { return live_count_; }
  /// Counter-clockwise seen from outside; empty for a vertex that is gone.
  [[nodiscard]] std::span<const std::uint32_t> ring(std::uint32_t vertex) const {
    return rings_[vertex];
  }
  [[nodiscard]] bool is_live(std::uint32_t vertex) const { return !rings_[vertex].empty(); }

  /// Whether the surface stays a triangulated one: the ends of the edge have two common
  /// neighbours, and there are more than four vertices. O(v log v) of the valences.
  [[nodiscard]] bool can_collapse(std::uint32_t vertex, std::uint32_t target) const;

  /// Moves `vertex` onto its neighbour `target`, which can_collapse() must allow, and appends the
  /// step to `record`. O(sum of the valences around).
  void collapse(std::uint32_t vertex, std::uint32_t target, CollapseRecord& record);

  /// Takes back the last collapse that was not taken back yet. O(sum of the valences around).
  void undo(const CollapseRecord& record, const RecordedCollapse& step);

  /// Three corners a triangle, ordered by their lowest vertex. O(n).
  [[nodiscard]] std::vector<std::uint32_t> triangles() const;

 private:
  std::vector<std::vector<std::uint32_t>> rings_;
  std::uint32_t live_count_ = 0;
};

}  // namespace varifold
