// What every collapse of a sequence changes in strips that were made once, of the full mesh.
#pragma once

#include <varifold/models/lodstrips/strip_slots.h>
#include <varifold/simplify/collapse_sequence.h>
#include <varifold/strip/triangle_strips.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// One change of one strip. Changes are for going down, in the order in which they stand; going up
/// undoes them in the opposite order.
struct StripChange {
  enum class Kind : std::uint8_t {
    kCollapse,   ///< the slot's vertex goes to its target
    kRemoveOne,  ///< StripSlots::remove() of one vertex twice, or of the last index (type one)
    kRemoveTwo,  ///< of two different vertices (type two)
  };
  std::uint32_t strip = 0;
  std::uint32_t position = 0;
  std::uint32_t moved = 0;  ///< kCollapse: which of the vertices that the step moves
  Kind kind = Kind::kCollapse;
};

/// The same triangles in strips of at most `max_indices`, in which every triangle can vanish when
/// its level says so. A triangle at a seam may vanish while its corners still are three vertices,
/// two of them wedges of one point: such a triangle gets a strip of its own. O(n log n).
[[nodiscard]] TriangleStrips cut_for_removal(const DetailedMesh& detailed,
                                             const TriangleStrips& strips,
                                             std::uint32_t max_indices);

/// Walks a sequence down with strips of cut_for_removal(). Strips that have become too short to
/// draw anything are left as they are. O(1) per change and shifted slot, scans of the touched
/// strips included.
class StaticRemoval {
 public:
  /// Both must outlive this.
  StaticRemoval(const DetailedMesh& detailed, const TriangleStrips& strips);

  [[nodiscard]] std::uint32_t level() const { return level_; }
  [[nodiscard]] const StripSlots& slots() const { return slots_; }

  /// One collapse, to level() - 1. Returns what it changed: strips ascending, and in each strip the
  /// collapses, by moved vertex and position, before the removals. Valid until the next call.
  std::span<const StripChange> collapse();

 private:
  struct Node {
    std::uint32_t strip, next;
  };
  struct LoneTriangle {
    std::uint32_t level, strip;
  };
  void move_vertex(std::uint32_t vertex, std::uint32_t moved);
  void remove_pairs(std::uint32_t strip, std::uint32_t low, std::uint32_t high);
  [[nodiscard]] bool is_redundant(std::uint32_t strip, std::uint32_t position) const;
  [[nodiscard]] bool ends_degenerate(std::uint32_t strip) const;
  void remove(std::uint32_t strip, std::uint32_t position);

  const CollapseSequence& sequence_;
  std::uint32_t level_;
  StripSlots slots_;
  std::vector<Node> nodes_;                  // lists of strips
  std::vector<std::uint32_t> first_, last_;  // per vertex, of the strips that have it
  std::vector<LoneTriangle> lone_;           // by rising level
  std::vector<StripChange> changes_;
};

}  // namespace varifold
