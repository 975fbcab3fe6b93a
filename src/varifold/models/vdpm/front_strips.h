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
/// the first to the second, where there is a free neighbour; from then on, of the two edges it may
/// leave a triangle by, across the one that turns clockwise as seen from the triangles' fronts,
/// else across the other one, and ends where neither has a free neighbour. A free neighbour has the
/// same edge the other way round, the same material and no strip yet; of several, the first in the
/// list. So strips stop at seams and borders, where the slots or the materials differ.
///
/// All triangles with three different corners are in the strips, once, with their orientation;
/// others are left out. The result depends on the list alone. O(triangles * valence + vertices), 45
/// bytes a triangle and 4 a vertex of the greatest list; allocates only where a list is greater
/// than all before.
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
  // A half-edge in the row of the vertex that it begins at.
  struct Spoke {
    std::uint32_t end;
    std::uint32_t half_edge;  // 4 * place + corner
  };
  struct Spiral;
  [[nodiscard]] std::size_t mark_free(const DrawList& triangles);
  void sort_spokes(const DrawList& triangles, std::size_t spokes);

  std::vector<std::uint32_t> free_;   // per triangle of the list: its material until it has a strip
  std::vector<std::uint32_t> begin_;  // per vertex, where its row begins
  std::vector<Spoke> spokes_;         // and indices_: all that there is room for
  std::vector<std::uint32_t> indices_;
  std::size_t index_count_ = 0;
  std::vector<DrawRange> ranges_;
  ElementRange all_;
  StripJoin join_ = StripJoin::kRestart;
};

}  // namespace varifold
