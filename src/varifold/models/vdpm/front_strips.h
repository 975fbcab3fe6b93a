// Triangle strips of a front, made anew for each frame.
//
// Based on: [Hoppe1997] section 6 and [Giger], rendering: strips that grow greedily in a clockwise
//   spiral within one material.
// Differs: strips are indices, with a repeated one where a strip turns twice the same way, and a
//   restart or repeats between strips; the neighbours of triangles are sorted out from the index
//   buffer alone, so that splits and collapses keep no adjacency for this.
#pragma once

#include <varifold/strip/triangle_strips.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

/// A strip begins at the first triangle of the list that no strip has yet. It goes on across the
/// edge from the second corner to the third, else that from the third to the first, else that from
/// the first to the second, where there is a free neighbour. From then on, of the two edges that it
/// may leave a triangle by, it takes the one that turns clockwise as seen from the triangles'
/// fronts, else the other one; it ends where neither has a free neighbour. The neighbour across an
/// edge is the first triangle of the list that has this edge the other way round; it is free if it
/// has the same material and no strip yet. So strips stop at borders and seams, where vertices or
/// materials differ.
///
/// All triangles with three different corners are in the strips, once, with their orientation;
/// others are left out. The result depends on the list alone. O(triangles + vertices). 72 bytes a
/// triangle and 12 a vertex of the greatest list (80 where joined by repeats); allocates only where
/// a list is greater than all before.
class FrontStrips {
 public:
  /// The strips of a list of triangles, whose ranges begin at multiples of three, as one range for
  /// each run of ranges of one material; vertices are those of the list. All
  /// indices count as changed. Valid until the next call.
  [[nodiscard]] DrawList build(const DrawList& triangles, StripJoin join = StripJoin::kRestart);
  /// The same strips again, for a list that has the same triangles as the one before: only vertices
  /// may have changed. O(1).
  [[nodiscard]] DrawList again(const DrawList& triangles) const;
  /// What the last build was given.
  [[nodiscard]] StripJoin join() const { return join_; }

  [[nodiscard]] std::size_t bytes() const;

 private:
  // A corner of a triangle in the row of its vertex; the two others, in the order of the triangle.
  struct Spoke {
    std::uint32_t half_edge;  // 4 * place + corner: from here to `end`
    std::uint32_t end, before;
  };
  // Of the half-edges to a vertex, the last one that was seen, and where it comes from.
  struct Mark {
    std::uint32_t from, half_edge;
  };
  struct Spiral;
  [[nodiscard]] std::size_t mark_free(const DrawList& triangles);
  void sort_spokes(const DrawList& triangles, std::size_t spokes);
  void pair_half_edges(std::size_t vertices, std::size_t places);

  std::vector<std::uint32_t> free_;   // per triangle of the list: its material until it has a strip
  std::vector<std::uint32_t> begin_;  // per vertex, where its row begins
  std::vector<Spoke> spokes_;
  std::vector<Mark> marks_;            // per vertex
  std::vector<std::uint32_t> across_;  // per half-edge, the one that runs the other way, or kNone
  std::vector<std::uint32_t> indices_;
  std::size_t index_count_ = 0;
  std::vector<DrawRange> ranges_;
  ElementRange all_;
  StripJoin join_ = StripJoin::kRestart;
};

}  // namespace varifold
