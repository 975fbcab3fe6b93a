// Taking degenerate triangles out of a strip without touching the others.
//
// Based on: [Ramos2008] 2.3.2 and 4.2.2 (filters), 3.5 (strips that break).
// Differs: indices leave a strip's middle in pairs only, whatever the pattern, so that the
// triangles
//   after them keep their orientation; what the published patterns remove as odd numbers stays.
#pragma once

#include <varifold/base/math.h>
#include <varifold/view/draw_list.h>
#include <array>
#include <cstdint>
#include <vector>

namespace varifold::mts {

/// One place of a strip: a vertex or kStripRestart, and the node of the graph that stands for it.
struct StripItem {
  std::uint32_t vertex = 0;
  std::uint32_t node = kNone;  ///< kNone: there is none yet
};

/// Makes a strip short: it removes pairs of indices whose triangles are degenerate, cuts off ends
/// that draw nothing, and breaks the strip by a restart where that takes fewer indices. The set of
/// oriented triangles that are not degenerate stays as it is. Never longer than before; empty where
/// nothing is drawn. O(length) for each removal.
class StripReducer {
 public:
  void reduce(std::vector<StripItem>& items);

 private:
  void reduce_part();
  bool break_part();

  std::vector<StripItem> part_, head_, result_;
};

/// Takes one triangle, by its corners up to rotation, out of a strip by breaking it there; false
/// where the strip has no such triangle.
bool cut_triangle(const std::array<std::uint32_t, 3>& corners, std::vector<StripItem>& items);

}  // namespace varifold::mts
