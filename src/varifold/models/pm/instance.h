// One place in a scene where a progressive mesh stands, at a level of its own.
#pragma once

#include <varifold/models/common/changed_blocks.h>
#include <varifold/models/pm/progressive_mesh.h>
#include <varifold/view/draw_list.h>
#include <cstdint>
#include <memory>
#include <vector>

namespace varifold {

/// A cursor over the levels of a model. Owns an index buffer (12 bytes a triangle; the vertex
/// buffer is the model's, unless placement moves vertices) and changes it in place.
class ProgressiveMeshInstance {
 public:
  /// Begins at level 0. O(size of the model).
  explicit ProgressiveMeshInstance(std::shared_ptr<const ProgressiveMesh> model);

  [[nodiscard]] const ProgressiveMesh& model() const { return *model_; }
  [[nodiscard]] std::uint32_t level() const { return level_; }
  [[nodiscard]] std::uint32_t vertex_count() const { return vertex_count_; }
  [[nodiscard]] std::uint32_t triangle_count() const { return triangle_count_; }

  /// Splits or collapses until `level` (at most the model's finest). Allocates nothing; about four
  /// words written a step. The buffers depend on the level alone, not on the way to it.
  void go_to_level(std::uint32_t level);

  /// Draw-ready buffers of the present level; what changed since the last call of this function.
  /// Valid until the next go_to_level().
  [[nodiscard]] DrawList draw_list();

  /// The index buffer, of which each range's first triangles belong to the level.
  [[nodiscard]] const std::vector<std::uint32_t>& indices() const { return indices_; }
  /// The vertex attributes at the level.
  [[nodiscard]] const TriangleMesh& vertices() const {
    return model_->moves_vertices() ? moved_ : model_->data().mesh;
  }

  /// Memory of the instance alone.
  [[nodiscard]] std::size_t bytes() const;

  /// A copy of the level as a mesh of its own, its ranges sorted by material. O(level).
  [[nodiscard]] TriangleMesh extract() const;

 private:
  template <class Value>
  void set_slots(const std::uint32_t* slots, VertexSplit split, std::uint32_t vertex,
                 const Value& value);
  void split_to(std::uint32_t level);
  void collapse_to(std::uint32_t level);
  void place(std::uint32_t vertex, const TriangleMesh& from, std::uint32_t index);
  void update_ranges();
  void append_ranges(std::vector<DrawRange>& ranges) const;

  std::shared_ptr<const ProgressiveMesh> model_;
  std::uint32_t level_ = 0;
  std::uint32_t vertex_count_ = 0;
  std::uint32_t triangle_count_ = 0;
  std::uint32_t slot_cursor_ = 0;
  std::vector<std::uint32_t> indices_;
  TriangleMesh moved_;                       // vertex attributes, where placement moves them
  std::vector<std::uint32_t> range_counts_;  // triangles of each range at the level
  std::vector<DrawRange> ranges_;
  ChangedBlocks changed_indices_, changed_vertices_;
};

}  // namespace varifold
