// One vertex split as it stands in a stream, and the surface that writer and reader grow by it.
//
// Based on: [Hoppe1996] sections 3.2 and 5 (a split as a few numbers; progressive transmission).
// Differs: a mask over the triangles around the split vertex takes the place of the two
//   neighbours, so that a split needs no order around the vertex and the mesh may be non-manifold.
#pragma once

#include <varifold/models/pm/attribute_codes.h>
#include <varifold/models/pm/slot_lists.h>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold::pm {

/// One new vertex: slots of `target` become its own.
struct SplitWedge {
  std::uint32_t target = 0;
  std::uint32_t first_moved = 0;  ///< [first_moved, end_moved) of SplitRecord::moved
  std::uint32_t end_moved = 0;
  bool leads = false;   ///< has the triangle (new, target, first spoke)
  bool closes = false;  ///< has the triangle (new, last spoke, target)
};

struct NewTriangle {
  std::array<std::uint32_t, 3> corners{};
  std::uint32_t range = 0;
  friend bool operator==(const NewTriangle&, const NewTriangle&) = default;
};

/// All that a split changes. Kept and filled anew, so that its arrays are allocated once.
struct SplitRecord {
  enum class Kind : std::uint8_t {
    kPlain,     ///< one wedge with both of its triangles, as predicted
    kFan,       ///< one wedge or more, triangles as predicted
    kExplicit,  ///< anything
  };
  Kind kind = Kind::kPlain;
  std::vector<SplitWedge> wedges;
  std::vector<std::uint32_t> moved;  ///< slots, in the order of the lists
  std::vector<NewTriangle> triangles;
  std::vector<Codes> codes;  ///< of each new vertex
  std::vector<std::uint32_t> placed_vertices;
  std::vector<Codes> placed_codes;
  std::uint32_t error_drop = 0;

  /// What the models learn when the record is done.
  struct Lesson {
    std::uint16_t model;
    std::uint32_t value;
  };
  std::vector<Lesson> lessons;

  void clear();
};

/// Triangles that grow by splits: every vertex knows its slots (slot 3 t + c is corner c of
/// triangle t) as a list in the order of their arrival.
class SplitSurface {
 public:
  SplitSurface() = default;
  explicit SplitSurface(std::uint32_t range_count) : blocks_(range_count) {}

  /// Room for `count` triangles of a range, beside each other. Without it ranges grow in blocks.
  void reserve_range(std::uint32_t range, std::uint32_t count) { add_block(range, count); }
  /// Room without a change of layout.
  void reserve(std::size_t vertices, std::size_t triangles);

  [[nodiscard]] std::uint32_t vertex_count() const { return slots_.list_count(); }
  [[nodiscard]] std::uint32_t triangle_count() const { return triangle_count_; }
  [[nodiscard]] std::uint32_t range_count() const {
    return static_cast<std::uint32_t>(blocks_.size());
  }
  /// The index buffer; places of a block that no triangle has yet hold 0.
  [[nodiscard]] const std::vector<std::uint32_t>& corners() const { return corners_; }

  [[nodiscard]] std::vector<std::uint32_t> take_corners() { return std::move(corners_); }

  /// Where triangles of a range lie, in the order of their arrival.
  struct Block {
    std::uint32_t first = 0, count = 0, capacity = 0;
  };
  [[nodiscard]] std::span<const Block> blocks(std::uint32_t range) const { return blocks_[range]; }

  /// Begins to load the triangle of a slot.
  void prefetch(std::uint32_t slot) const { __builtin_prefetch(&corners_[slot]); }

  void add_vertices(std::uint32_t count) { slots_.add_lists(count); }
  /// Corners must be vertices. Returns the number of the triangle.
  std::uint32_t add_triangle(const NewTriangle& triangle);
  /// The slots of `vertex` that no earlier wedge of the record takes, in the order of their
  /// arrival. The result lies in the surface or in `scratch`.
  [[nodiscard]] std::span<const std::uint32_t> free_slots(
      const SplitRecord& record, std::uint32_t vertex, std::vector<std::uint32_t>& scratch) const;
  /// Appends the triangles that the wedge's flags promise, or returns false where its moved slots
  /// do not tell them. `vertex` is the new one.
  [[nodiscard]] bool predict_triangles(const SplitRecord& record, const SplitWedge& wedge,
                                       std::uint32_t vertex,
                                       std::vector<NewTriangle>& triangles) const;
  /// The next corner of every triangle that new vertex `wedge_index` will have, appended to `ring`:
  /// around an inner vertex, all of its neighbours.
  void ring_of(const SplitRecord& record, std::uint32_t wedge_index,
               std::vector<std::uint32_t>& ring) const;
  /// Does what the record says. Slots and targets must be as free_slots() gave them.
  void apply(const SplitRecord& record);
  /// The numbers of the triangles that the last apply() added.
  [[nodiscard]] std::span<const std::uint32_t> added() const { return added_; }

 private:
  /// Beyond so many moved triangles the fan is not searched.
  static constexpr std::uint32_t kMaxFan = 64;

  void add_block(std::uint32_t range, std::uint32_t capacity);
  [[nodiscard]] std::uint32_t corner_after(std::uint32_t slot) const {
    return corners_[slot % 3 == 2 ? slot - 2 : slot + 1];
  }
  [[nodiscard]] std::uint32_t corner_before(std::uint32_t slot) const {
    return corners_[slot % 3 == 0 ? slot + 2 : slot - 1];
  }
  [[nodiscard]] std::uint32_t range_of(std::uint32_t triangle) const {
    return range_of_triangle_.empty() ? 0 : range_of_triangle_[triangle];
  }

  std::uint32_t triangle_count_ = 0;
  std::vector<std::uint32_t> corners_;            // per slot
  SlotLists slots_;                               // per vertex
  std::vector<std::uint32_t> range_of_triangle_;  // only where there are several
  std::vector<std::vector<Block>> blocks_;        // per range
  std::vector<std::uint32_t> added_;
};

/// What writer and reader of a stream both know before a record, and change by it alike.
struct StreamState {
  AttributeCoder coder;
  SplitSurface surface;
  std::vector<std::uint32_t> table;  ///< codes of all vertices, channel_count() each
  CodeModels models;
  std::uint32_t error = 0;  ///< of the level; see error_code.h
  bool moves_vertices = false;

  [[nodiscard]] Codes codes_of(std::uint32_t vertex) const;
  void apply(const SplitRecord& record);
};

/// Predicts the codes of new vertex `wedge_index` of a record whose connectivity is known, as are
/// the codes of earlier wedges. `ring` is scratch.
[[nodiscard]] Prediction predict_vertex(const StreamState& state, const SplitRecord& record,
                                        std::uint32_t wedge_index,
                                        std::vector<std::uint32_t>& ring);

/// The vertices that a split moves back where nothing else is said: its targets, each once.
void predict_placed_vertices(const SplitRecord& record, std::vector<std::uint32_t>& vertices);

/// The index of the wedge that splits off `vertex`; 0 where none does.
[[nodiscard]] std::uint32_t split_off(const SplitRecord& record, std::uint32_t vertex);

}  // namespace varifold::pm
