// The progressive mesh: any level of one mesh, exactly, from one buffer of triangles.
//
// Based on: [Hoppe1996] section 2; levels as prefixes of one vertex and one index buffer.
// Differs: splits store the places in the index buffer that they change instead of neighbours, so a
//   step writes about four words and the buffer is ready to be drawn after each.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace varifold {

/// What one vertex split adds, and how many places of the index buffer it changes.
struct VertexSplit {
  std::uint16_t slots = 0;
  std::uint8_t vertices = 0;   ///< wedges of the new point
  std::uint8_t triangles = 0;  ///< two, but on borders and non-manifold edges
};

/// The arrays of a progressive mesh, all of it plain data; see ProgressiveMesh for what they mean.
struct ProgressiveMeshData {
  /// Vertex attributes at full detail, materials and images. `mesh.indices` is the index buffer of
  /// level 0: right for the triangles of the base; every other triangle holds what it has when it
  /// appears. `mesh.ranges` are those of the full level.
  TriangleMesh mesh;
  std::uint32_t base_vertices = 0;
  std::uint32_t base_triangles = 0;
  std::vector<VertexSplit> splits;
  /// The places that the splits change, in their order. Slot 3 t + c is corner c of triangle t.
  /// The high bit ends the slots of one new vertex; beside others, a vertex without slots has
  /// kNoSlot.
  std::vector<std::uint32_t> slots;
  std::vector<std::uint32_t> target;          ///< per vertex: where it collapses to
  std::vector<std::uint32_t> triangle_level;  ///< only where there are several ranges
  std::vector<float> error;                   ///< per level, size splits + 1
  bool error_is_measured = false;

  /// With optimal placement: the collapse to level k sets vertex placed_vertex[j] to the attributes
  /// j of `placed`, for j in [first_placed[k], first_placed[k + 1]); the split back to level k + 1
  /// sets it to the attributes finer[j] of `placed`, or, for kNone, to those at full detail.
  std::vector<std::uint32_t> first_placed, placed_vertex, finer;
  TriangleMesh placed;

  static constexpr std::uint32_t kLastSlot = 0x80000000u;
  static constexpr std::uint32_t kNoSlot = 0x7fffffffu;
};

/// Immutable, shared by any number of instances and threads.
class ProgressiveMesh {
 public:
  /// A ring of counts every so many levels makes looking up a level's counts O(1).
  static constexpr std::uint32_t kCheckpoint = 64;

  ProgressiveMesh() = default;
  /// The arrays must be consistent, as from build_progressive_mesh() or decode_progressive_mesh().
  explicit ProgressiveMesh(ProgressiveMeshData data);

  [[nodiscard]] const ProgressiveMeshData& data() const { return data_; }
  /// The arrays themselves; the model is left empty.
  [[nodiscard]] ProgressiveMeshData release() && {
    checkpoints_.clear();
    return std::move(data_);
  }
  /// The vertex attributes at full detail, materials and images.
  [[nodiscard]] const TriangleMesh& attributes() const { return data_.mesh; }
  /// Levels run from 0, the base, to this, full detail.
  [[nodiscard]] std::uint32_t finest_level() const {
    return static_cast<std::uint32_t>(data_.splits.size());
  }
  [[nodiscard]] std::uint32_t vertex_count(std::uint32_t level) const;
  [[nodiscard]] std::uint32_t triangle_count(std::uint32_t level) const;
  [[nodiscard]] std::uint32_t triangle_count() const { return data_.mesh.triangle_count(); }
  /// A distance in model units; see CollapseSequence::error for what it bounds.
  [[nodiscard]] float error(std::uint32_t level) const { return data_.error[level]; }
  [[nodiscard]] bool error_is_measured() const { return data_.error_is_measured; }
  [[nodiscard]] bool moves_vertices() const { return !data_.first_placed.empty(); }

  /// The finest level with at most so many triangles or vertices; 0 where even the base has more.
  [[nodiscard]] std::uint32_t level_for_triangles(std::uint32_t count) const;
  [[nodiscard]] std::uint32_t level_for_vertices(std::uint32_t count) const;
  /// The coarsest level whose error is at most `bound`.
  [[nodiscard]] std::uint32_t level_for_error(float bound) const;
  /// 1 is full detail, 0 the base; the vertex count is linear in between.
  [[nodiscard]] std::uint32_t level_for_fraction(float fraction) const;

  /// The vertex that stands for `vertex` at `level`. O(depth).
  [[nodiscard]] std::uint32_t ancestor(std::uint32_t vertex, std::uint32_t level) const;

  /// Memory of all arrays but images; vertices included.
  [[nodiscard]] std::size_t bytes() const;

 private:
  friend class ProgressiveMeshInstance;
  struct Counts {
    std::uint32_t vertices, triangles, slots;
  };
  [[nodiscard]] Counts counts(std::uint32_t level) const;

  ProgressiveMeshData data_;
  std::vector<Counts> checkpoints_;
};

}  // namespace varifold
