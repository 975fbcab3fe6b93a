// Private to this folder: the splits of a sequence in some twenty bits each.
//
// Based on: [Hoppe1996] section 3.4 (a split told by its place among the neighbours of the vertex).
// Differs: one bit for each corner at the target says whether it goes to the new vertex, so that
//   any split of any surface can be told; the third corner of a new triangle is a neighbour of the
//   two others.
#pragma once

#include <varifold/base/bit_stream.h>
#include <varifold/base/math.h>
#include <varifold/models/vdpm/step_records.h>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold::vdpm {

/// A surface that grows from the base up. Slot 3 t + c is corner c of triangle t; the slots of a
/// vertex are a list whose order depends on the history alone.
class GrowingSurface {
 public:
  GrowingSurface(std::uint32_t vertices, std::uint32_t triangles);

  /// All three corners must be below the number of vertices.
  void add(std::uint32_t triangle, const std::array<std::uint32_t, 3>& corners);
  /// Hands those slots of `target` to `vertex`, which has none, for which goes(slot) is true; asked
  /// in the order of the list.
  template <class Goes>
  void divide(std::uint32_t target, std::uint32_t vertex, const Goes& goes) {
    std::uint32_t slot = rows_[target].first;
    rows_[target] = {};
    while (slot != kNone) {
      const std::uint32_t next = slots_[slot].next;
      // What stays may be marked for another vertex.
      const bool is_going = goes(slot);
      if (is_going) slots_[slot].corner = vertex;
      append(is_going ? vertex : target, slot);
      slot = next;
    }
  }
  /// How many places neighbour() has.
  [[nodiscard]] std::uint32_t neighbours(std::uint32_t a, std::uint32_t b) const {
    return 2 * (rows_[a].count + rows_[b].count);
  }
  /// Other corners of the triangles of a, then of b; the same vertex may come again.
  [[nodiscard]] std::uint32_t neighbour(std::uint32_t a, std::uint32_t b,
                                        std::uint32_t place) const;
  /// The first place of `vertex`, or kNone.
  [[nodiscard]] std::uint32_t place_of(std::uint32_t vertex, std::uint32_t a,
                                       std::uint32_t b) const;
  [[nodiscard]] std::uint32_t corner(std::uint32_t slot) const { return slots_[slot].corner; }
  /// Marks a slot of a target for the vertex that it goes to; the next split must hand it over.
  void mark(std::uint32_t slot, std::uint32_t vertex) { slots_[slot].corner = vertex; }
  /// What the next splits will read may be fetched early.
  void prefetch(std::uint32_t slot) const { __builtin_prefetch(&slots_[slot]); }
  /// Of all slots. O(slots).
  [[nodiscard]] std::vector<std::uint32_t> corners() const;

 private:
  void append(std::uint32_t vertex, std::uint32_t slot);
  [[nodiscard]] std::uint32_t other(std::uint32_t slot, std::uint32_t which) const;

  struct Slot {
    std::uint32_t corner = 0, next = kNone;
  };
  struct Row {
    std::uint32_t first = kNone, last = kNone, count = 0;
  };
  std::vector<Slot> slots_;
  std::vector<Row> rows_;  // of the vertices
};

/// What both directions know of a step before they read or write its record.
struct SplitFrame {
  std::uint32_t first_vertex = 0, end_vertex = 0;
  std::span<const std::uint32_t> target;  ///< per vertex of the model
  std::uint32_t ranges = 1;
};

/// A new triangle and its place among the ranges.
struct NewTriangle {
  std::array<std::uint32_t, 3> corners{};
  std::uint32_t range = 0;
};

/// Which slots of the targets go to the vertices of a step: those that are marked for them.
/// Changes the surface.
void write_division(const SplitFrame& frame, GrowingSurface& surface, BitWriter& bits);
/// Appends the slots that go to `taken`, those of each vertex in one row, and where each row ends
/// to `taken_end`. False where the bits end.
[[nodiscard]] bool read_division(const SplitFrame& frame, GrowingSurface& surface, BitReader& bits,
                                 std::vector<std::uint32_t>& taken,
                                 std::vector<std::uint32_t>& taken_end);

void write_triangle(const SplitFrame& frame, const NewTriangle& triangle,
                    const GrowingSurface& surface, BitWriter& bits);
/// False where the corners are not three vertices of the level, one of them new.
[[nodiscard]] bool read_triangle(const SplitFrame& frame, const GrowingSurface& surface,
                                 BitReader& bits, NewTriangle& triangle);

/// The vertices that a collapse moves: mostly the targets.
void write_moved(const SplitFrame& frame, std::span<const std::uint32_t> moved, BitWriter& bits);
/// Appends to `moved`; false where the bits end or a vertex is not there at the coarser level.
[[nodiscard]] bool read_moved(const SplitFrame& frame, BitReader& bits,
                              std::vector<std::uint32_t>& moved);

}  // namespace varifold::vdpm
