// One place in a scene where multiresolution strips stand, at a level of their own.
#pragma once

#include <varifold/models/common/changed_blocks.h>
#include <varifold/models/mts/multiresolution_strips.h>
#include <varifold/view/draw_list.h>
#include <cstdint>
#include <memory>
#include <vector>

namespace varifold {

/// A cursor over the levels of a model; satisfies UniformInstance. Owns an index buffer in which
/// every strip has a slot as large as it ever gets, and one more; restarts fill it behind the
/// strip.
class MultiresolutionStripsInstance {
 public:
  /// Begins at level 0. O(size of the model).
  explicit MultiresolutionStripsInstance(std::shared_ptr<const MultiresolutionStrips> model);

  [[nodiscard]] const MultiresolutionStrips& model() const { return *model_; }
  [[nodiscard]] std::uint32_t level() const { return level_; }
  [[nodiscard]] std::uint32_t vertex_count() const { return model_->vertex_count(level_); }
  [[nodiscard]] std::uint32_t triangle_count() const { return model_->triangle_count(level_); }

  /// Walks again those strips whose state differs between the present level and `level` (at most
  /// the model's finest). O(strips + indices of the strips that change); allocates nothing. The
  /// buffers depend on the level alone, not on the way to it.
  void go_to_level(std::uint32_t level);

  /// The strips in the order of the materials; those with one restart between them are one range.
  /// What changed since the last call of this function. Valid until the next go_to_level().
  /// O(strips); allocates nothing.
  [[nodiscard]] DrawList draw_list();

  [[nodiscard]] const std::vector<std::uint32_t>& indices() const { return indices_; }
  /// Memory of the instance alone.
  [[nodiscard]] std::size_t bytes() const;
  /// A copy of the level as a mesh of its own, with materials. O(level).
  [[nodiscard]] TriangleMesh extract() const;

 private:
  void walk(std::uint32_t strip);
  void append_ranges(std::vector<DrawRange>& ranges) const;

  std::shared_ptr<const MultiresolutionStrips> model_;
  std::uint32_t level_ = 0;
  std::vector<std::uint32_t> indices_;
  std::vector<std::uint32_t> lengths_;  // per strip
  // Per strip, the levels of its present state: lowest_ and so many above.
  std::vector<std::uint32_t> lowest_, above_;
  std::vector<DrawRange> ranges_;
  ChangedBlocks changed_;
};

}  // namespace varifold
