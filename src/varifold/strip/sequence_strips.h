// Strips that grow along a collapse sequence: made for the base mesh, then changed by every split
// so that they stay long at all levels.
//
// Based on: the idea of building strips from the coarsest level on, [RipollesChoverRamos2005], and
// the strips of
//   [Ramos2008] chapter 4, whose degenerate runs this turns round: the run that a collapse would
//   leave behind is where a split puts its new triangle.
// Differs: strips lie in blocks of a bounded number of slots, divided by restarts. They may be
//   lengthened at both ends, turned round and cut, and short strips are opened beside their
//   neighbours, so that no level has many indices to spare and a split touches two blocks.
#pragma once

#include <varifold/simplify/sequence_history.h>
#include <varifold/strip/triangle_strips.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// A change of one block. Every kind has an exact inverse, so a list of them can be played both
/// ways; block and slot numbers are those at the time of the change.
struct BlockChange {
  enum Kind : std::uint8_t {
    kSet,        ///< slot becomes `value`, a new vertex; before it had the target of that vertex
    kDuplicate,  ///< the slots slot, slot + 1 are repeated after them
    kInsert,     ///< `value`, a vertex or a restart, comes before the slot
    kOpen,       ///< a strip of one triangle after the last slot; see below
    kAssign,     ///< the slot, a copy of the one after it, becomes `value`
    kRotate,     ///< the slots slot, slot + 1, slot + 2 move left by `detail`
    kReverse,    ///< the order of `detail` slots from `slot` on is turned round
    kSplit,      ///< the slots from `slot` on go to a new block; see SplitWay
    kNewBlock    ///< a new block, empty, for the material range `value`
  };
  /// kOpen: `slot` is where the triangle begins, after a restart unless the block was empty. It is
  /// a new vertex, its target and `value`, in one of six orders: `detail` is twice the place of
  /// `value`, and one more where the target comes before the new vertex.
  /// Between two strips, the restart before `slot` goes; inside a strip its first two slots stay in
  /// the old block too.
  enum SplitWay : std::uint8_t { kBetween, kInside };

  Kind kind = kSet;
  std::uint8_t slot = 0;
  std::uint8_t detail = 0;
  std::uint32_t block = 0;
  std::uint32_t value = 0;
  std::uint32_t vertex = 0;  ///< kOpen: the new vertex
  /// kInsert, kOpen, kAssign: a slot of the block that has `value` before the change, or kNoSlot.
  std::uint8_t from = kNoSlot;
  static constexpr std::uint8_t kNoSlot = 255;
};

/// Walks a sequence from the base up. O(1) blocks are looked at in a step.
class SequenceStrips {
 public:
  static constexpr std::uint32_t kMaxSlots = 64;

  /// Per triangle, its corner that comes first when a strip is opened with it; kAnyCorner where
  /// that does not matter. A strip of one triangle must turn before it can grow in some directions;
  /// what one walk learns saves the next one these changes.
  using FirstCorners = std::vector<std::uint8_t>;
  static constexpr std::uint8_t kAnyCorner = 3;

  /// The base, in strips. `detailed` and `history` must outlive this. `first` is empty or what
  /// another walk of the same sequence has learned; all else is the same with it and without it.
  SequenceStrips(const DetailedMesh& detailed, const SequenceHistory& history,
                 FirstCorners first = {});

  /// What has been learned so far.
  [[nodiscard]] const FirstCorners& first_corners() const { return learned_; }

  [[nodiscard]] std::uint32_t level() const { return level_; }
  [[nodiscard]] std::uint32_t block_count() const {
    return static_cast<std::uint32_t>(blocks_.size());
  }
  /// The slots of a block: strips divided by kStripRestart, none of them empty.
  [[nodiscard]] std::span<const std::uint32_t> block(std::uint32_t b) const {
    return {blocks_[b].slots, blocks_[b].count};
  }
  [[nodiscard]] std::uint32_t material_range(std::uint32_t b) const { return blocks_[b].range; }

  /// Where the blocks may stand in one buffer, so that none runs into another at any level up to
  /// the present one. A block that comes from splitting another may stand where that one reached
  /// before, so the buffer is hardly larger than what the finest level needs. O(blocks).
  struct Layout {
    std::vector<std::uint32_t> first;  // per block
    std::uint32_t size = 0;
  };
  [[nodiscard]] Layout layout() const;

  /// One split, to level() + 1. Afterwards changes() tells what it did, in order.
  void split();
  [[nodiscard]] std::span<const BlockChange> changes() const { return changes_; }

  [[nodiscard]] TriangleStrips strips() const;

 private:
  struct Block {
    std::uint32_t slots[kMaxSlots];
    std::uint32_t triangle[kMaxSlots];  // that begins at the slot, or kNone
    std::uint32_t count = 0;
    std::uint32_t most = 0;  // slots since the last split of the block
    std::uint32_t range = 0;
    std::uint32_t last_split = kNone;  // in splits_
  };
  // The history of a block's size, backwards.
  struct BlockSplit {
    std::uint32_t most;  // slots before it
    std::uint32_t child;
    std::uint32_t previous;  // split of the same block
  };
  struct Corner {  // a corner of a triangle that goes to a new vertex
    std::uint32_t block, triangle, corner, vertex;
  };
  struct Edge {
    std::uint32_t triangle, edge;
  };
  struct Conflict {
    std::uint32_t place = kNone;  // of the later triangle
    bool has_face = false;        // a new triangle fits in between
  };
  // How a triangle joins a strip at one of its ends.
  struct Placement {
    enum Way : std::uint8_t { kNowhere, kTail, kTailTurn, kRotated, kReversed, kHeadPair, kPad };
    Way way = kNowhere;
    std::uint32_t cost = kNone, block = 0, place = 0, value = 0, rotation = 0;
  };

  void load_base(const DetailedMesh& detailed);
  void load_strips(const TriangleMesh& base, const std::vector<std::uint32_t>& triangles);
  void link_open_edges();
  void gather_corners();
  void update_links();
  [[nodiscard]] bool matches(Edge a, Edge b) const;
  [[nodiscard]] Edge across(Edge edge) const;

  void change_block(std::uint32_t b, std::span<const Corner> corners);
  [[nodiscard]] Conflict find_conflict(const Block& block, const std::uint32_t* wanted) const;
  [[nodiscard]] bool fits_between(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  void set_slots(std::uint32_t b, const std::uint32_t* wanted);
  [[nodiscard]] std::uint32_t claim_new_triangles(std::uint32_t b);
  void break_run(std::uint32_t b, std::uint32_t place);
  void cut_strip(std::uint32_t b, std::uint32_t place);

  void place_new_triangles();
  [[nodiscard]] Placement best_placement(std::uint32_t triangle) const;
  [[nodiscard]] Placement placement_at(std::uint32_t triangle, std::uint32_t edge) const;
  [[nodiscard]] bool place(std::uint32_t triangle, const Placement& placement);
  void open(std::uint32_t triangle);
  void learn_first_corner(std::uint32_t triangle, std::uint32_t vertex);
  [[nodiscard]] std::uint32_t block_for(std::uint32_t triangle);

  /// Makes room for `slots` more in a block by splitting it; false where it had the room.
  bool make_room(std::uint32_t b, std::uint32_t slots);
  [[nodiscard]] std::uint32_t best_split(const Block& block) const;

  void apply(const BlockChange& change);
  void split_block(const BlockChange& change);
  void new_block(std::uint32_t range);
  void set_triangle(std::uint32_t b, std::uint32_t place, std::uint32_t triangle);
  [[nodiscard]] static std::uint32_t place_of(const Block& block, std::uint32_t triangle);
  [[nodiscard]] static std::uint32_t strip_begin(const Block& block, std::uint32_t place);
  [[nodiscard]] static std::uint32_t strip_end(const Block& block, std::uint32_t place);
  [[nodiscard]] std::uint32_t corner(Edge e) const { return corners_[3 * e.triangle + e.edge % 3]; }
  [[nodiscard]] const std::uint32_t* corners_of(std::uint32_t triangle) const {
    return corners_.data() + 3 * std::size_t{triangle};
  }
  [[nodiscard]] std::uint32_t range_of(std::uint32_t triangle) const {
    return range_of_.empty() ? 0 : range_of_[triangle];
  }

  const CollapseSequence& sequence_;
  const SequenceHistory& history_;
  std::uint32_t level_ = 0;
  std::vector<Block> blocks_;
  std::vector<BlockSplit> splits_;
  std::vector<std::uint32_t> corners_;     // at the present level
  std::vector<std::uint32_t> neighbor_;    // per edge (corner e to corner e + 1)
  std::vector<std::uint32_t> block_of_;    // per triangle
  std::vector<std::uint32_t> range_of_;    // per triangle, where there are several ranges
  std::vector<std::uint32_t> last_block_;  // per range: where a lone triangle may go
  FirstCorners first_, learned_;
  std::vector<BlockChange> changes_;
  std::vector<Corner> moved_;
  std::vector<Edge> open_;
  std::vector<std::uint32_t> pieces_;    // blocks that a step has made of one
  std::vector<std::uint32_t> unplaced_;  // new triangles that are in no strip yet
};

/// The strips that SequenceStrips has at the full level: for models whose strips are static. O(n).
[[nodiscard]] TriangleStrips stripify_along_sequence(const DetailedMesh& detailed);

}  // namespace varifold
