// What choosing fronts of a patch tree reads, laid out for it.
#pragma once

#include <varifold/models/patch_tree/patch_tree.h>
#include <varifold/models/patch_tree/required_nodes.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace varifold {

/// The numbers of the bounds of inner nodes, side by side, so that eight nodes are asked at once.
/// Padded with nodes that nothing ever asks for.
struct FrontLanes {
  std::vector<float> x, y, z, radius;                       ///< of the ball
  std::vector<float> error, mean_squared;                   ///< as in PatchBounds
  std::vector<float> axis_x, axis_y, axis_z, cosine, sine;  ///< of the cone
  /// FrontTables::no_parent() for roots and what is padded.
  std::vector<std::uint32_t> parent;
};

/// Made once per tree, then immutable and shared by all fronts of it. Inner nodes are those with
/// children; they are the first ones. 80 to 100 bytes an inner node.
class FrontTables {
 public:
  static constexpr std::uint32_t kWordBits = 64;
  /// Reverse slot of a node that has no bit for the other one.
  static constexpr std::uint8_t kNoSlot = 255;

  /// Needs of the tree topology, bounds and offsets only. O(nodes + neighbours squared a node).
  explicit FrontTables(std::shared_ptr<const PatchTree> tree);

  [[nodiscard]] const PatchTree& tree() const { return *tree_; }
  [[nodiscard]] const PatchTopology& topology() const { return tree_->topology(); }
  [[nodiscard]] std::uint32_t root_count() const { return root_count_; }
  [[nodiscard]] std::uint32_t inner_count() const { return inner_count_; }
  /// Of a set with a bit for each inner node.
  [[nodiscard]] std::uint32_t word_count() const {
    return (inner_count_ + kWordBits - 1) / kWordBits;
  }
  /// Where arrays of priorities keep one that is greater than all: the end of the padding.
  [[nodiscard]] std::uint32_t no_parent() const { return word_count() * kWordBits; }
  /// Of nodes from here on the parent is not among the seven before the node.
  [[nodiscard]] std::uint32_t first_apart() const { return first_apart_; }

  [[nodiscard]] const FrontLanes& lanes() const { return lanes_; }
  [[nodiscard]] std::span<const std::uint32_t> required_by(std::uint32_t node) const {
    return required_.of(node);
  }
  /// Triangles that a front gains when the node is split; not negative.
  [[nodiscard]] std::uint32_t growth(std::uint32_t node) const { return growth_[node]; }
  [[nodiscard]] std::uint32_t root_triangles() const { return root_triangles_; }
  /// Per entry of PatchTopology::neighbors of an inner node: the place of the node among the
  /// neighbours of that neighbour, or kNoSlot.
  [[nodiscard]] const std::uint8_t* reverse_slots() const { return reverse_slots_.data(); }

  [[nodiscard]] std::size_t bytes() const;

 private:
  void lay_out_bounds();
  void find_reverse_slots();

  std::shared_ptr<const PatchTree> tree_;
  std::uint32_t root_count_ = 0, inner_count_ = 0, first_apart_ = 0, root_triangles_ = 0;
  FrontLanes lanes_;
  RequiredNodes required_;
  std::vector<std::uint32_t> growth_;
  std::vector<std::uint8_t> reverse_slots_;
};

}  // namespace varifold
