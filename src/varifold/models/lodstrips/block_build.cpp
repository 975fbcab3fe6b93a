#include <varifold/models/lodstrips/block_form.h>
#include <varifold/models/lodstrips/block_records.h>
#include <varifold/simplify/sequence_history.h>
#include <varifold/strip/sequence_strips.h>
#include <algorithm>
#include <cassert>
#include <span>

namespace varifold {

namespace {

using Bytes = std::vector<std::uint8_t>;

// The changes of one split as bytes.
class StepWriter {
 public:
  StepWriter(const CollapseSequence& sequence, blocks::WordFormat format)
      : sequence_(sequence), format_(format) {}

  void write(std::uint32_t level, std::span<const BlockChange> changes, Bytes& records) {
    first_ = sequence_.vertices[level];
    end_ = sequence_.vertices[level + 1];
    groups_.clear();
    for (const BlockChange& change : changes) append(group_of(change), change);
    for (const Group& group : groups_) write_group(group, records);
  }

 private:
  struct Group {
    std::uint32_t block = 0;
    std::uint32_t vertex = 0;  // that the next operation speaks of
    bool makes_block = false;
    Bytes duplicates, sets;
    Bytes bytes;  // of the rest
  };

  void write_group(const Group& group, Bytes& records) const {
    // The two most frequent rests are written the short way.
    const Bytes& rest = group.bytes;
    const bool inserts = !rest.empty() && (rest[0] & 3u) == blocks::kInsertTarget;
    auto slot = static_cast<std::uint8_t>(rest.empty() ? 0 : rest[0] >> 2u);
    blocks::Rest way = rest.empty() ? blocks::kNothing : blocks::kMixed;
    if (inserts && rest.size() == 1) way = blocks::kTargetInserted;
    if (inserts && rest.size() == 2 && rest[1] == code(blocks::kSet, slot))
      way = blocks::kVertexInserted;
    const bool opens = rest.size() == 3 && rest[0] == code(blocks::kExtended, blocks::kOpenCopy);
    if (opens) {
      way = rest[1] < 4 ? blocks::kOpened : blocks::kOpenedHigh;
      slot = static_cast<std::uint8_t>(rest[1] % 4 | rest[2] << 2u);
    }
    const auto high = static_cast<std::uint32_t>(group.duplicates.size() | group.sets.size() << 2u |
                                                 unsigned{way} << 5u);
    const std::uint32_t word = group.block | high << format_.id_bits;
    for (std::uint32_t b = 0; b < format_.bytes; ++b)
      records.push_back(static_cast<std::uint8_t>(word >> (8 * b)));
    records.insert(records.end(), group.duplicates.begin(), group.duplicates.end());
    records.insert(records.end(), group.sets.begin(), group.sets.end());
    if (way == blocks::kMixed) {
      assert(rest.size() < 256);
      records.push_back(static_cast<std::uint8_t>(rest.size()));
      records.insert(records.end(), rest.begin(), rest.end());
    } else if (way != blocks::kNothing) {
      records.push_back(slot);
    }
  }

  static bool makes_block(const BlockChange& change) {
    return change.kind == BlockChange::kSplit || change.kind == BlockChange::kNewBlock;
  }

  // Blocks do not depend on each other, but new ones are numbered in the order of the changes.
  Group& group_of(const BlockChange& change) {
    constexpr std::size_t kMostBytes = 200;
    for (std::size_t i = groups_.size(); i-- > 0;) {
      Group& group = groups_[i];
      if (group.block == change.block) {
        if (group.bytes.size() < kMostBytes) return group;
        break;
      }
      if (group.makes_block && makes_block(change)) break;
    }
    groups_.push_back({change.block, first_, false, {}, {}, {}});
    return groups_.back();
  }

  [[nodiscard]] static std::uint8_t code(blocks::Kind kind, std::uint32_t detail) {
    return static_cast<std::uint8_t>(kind | detail << 2u);
  }
  static void extended(Group& group, blocks::Extended what) {
    group.bytes.push_back(code(blocks::kExtended, what));
  }
  static void value(Group& group, std::uint32_t v) {
    for (std::uint32_t b = 0; b < 4; ++b)
      group.bytes.push_back(static_cast<std::uint8_t>(v >> (8 * b)));
  }

  void select(Group& group, std::uint32_t vertex) const {
    if (vertex < group.vertex) {
      extended(group, blocks::kFirst);
      group.vertex = first_;
    }
    while (group.vertex < vertex) {
      const std::uint32_t by = std::min(255u, vertex - group.vertex);
      extended(group, blocks::kAdvance);
      group.bytes.push_back(static_cast<std::uint8_t>(by));
      group.vertex += by;
    }
  }

  [[nodiscard]] bool is_new(std::uint32_t v) const { return v >= first_ && v < end_; }
  // A new vertex whose target is v, the present one if it can be.
  [[nodiscard]] std::uint32_t vertex_to(std::uint32_t v, std::uint32_t present) const {
    if (sequence_.target[present] == v) return present;
    for (std::uint32_t u = first_; u < end_; ++u)
      if (sequence_.target[u] == v) return u;
    return kNone;
  }

  // A value that is copied from a slot where it stands in one.
  static void copy_or_value(Group& group, const BlockChange& change, blocks::Extended copy,
                            blocks::Extended as_value, std::uint8_t before) {
    const bool has_copy = change.from != BlockChange::kNoSlot;
    extended(group, has_copy ? copy : as_value);
    group.bytes.push_back(before);
    if (has_copy)
      group.bytes.push_back(change.from);
    else
      value(group, change.value);
  }

  void insert(Group& group, const BlockChange& change) const {
    if (change.value == kStripRestart) {
      extended(group, blocks::kInsertRestart);
      group.bytes.push_back(change.slot);
      return;
    }
    const std::uint32_t vertex =
        is_new(change.value) ? change.value : vertex_to(change.value, group.vertex);
    if (vertex == kNone)
      return copy_or_value(group, change, blocks::kInsertCopy, blocks::kInsertValue, change.slot);
    select(group, vertex);
    group.bytes.push_back(code(blocks::kInsertTarget, change.slot));
    if (vertex == change.value) group.bytes.push_back(code(blocks::kSet, change.slot));
  }

  void append(Group& group, const BlockChange& change) const {
    switch (change.kind) {
      case BlockChange::kSet:
        if (group.bytes.empty() && change.value == first_ &&
            group.sets.size() < blocks::WordFormat::kMostSets) {
          group.sets.push_back(change.slot);
          return;
        }
        select(group, change.value);
        group.bytes.push_back(code(blocks::kSet, change.slot));
        return;
      case BlockChange::kDuplicate:
        if (group.bytes.empty() && group.sets.empty() &&
            group.duplicates.size() < blocks::WordFormat::kMostDuplicates) {
          group.duplicates.push_back(change.slot);
          return;
        }
        group.bytes.push_back(code(blocks::kDuplicate, change.slot));
        return;
      case BlockChange::kInsert:
        return insert(group, change);
      case BlockChange::kOpen: {
        select(group, change.vertex);
        return copy_or_value(group, change, blocks::kOpenCopy, blocks::kOpenValue, change.detail);
      }
      case BlockChange::kAssign:
        return copy_or_value(group, change, blocks::kAssignCopy, blocks::kAssignValue, change.slot);
      case BlockChange::kRotate:
        extended(group, change.detail == 1 ? blocks::kRotateOne : blocks::kRotateTwo);
        break;
      case BlockChange::kReverse:
        extended(group, blocks::kReverse);
        break;
      case BlockChange::kSplit:
        group.makes_block = true;
        extended(group, change.detail == BlockChange::kBetween ? blocks::kSplitBetween
                                                               : blocks::kSplitInside);
        break;
      case BlockChange::kNewBlock:
        group.makes_block = true;
        extended(group, blocks::kNewBlock);
        return;
    }
    group.bytes.push_back(change.slot);
    if (change.kind == BlockChange::kReverse) group.bytes.push_back(change.detail);
  }

  const CollapseSequence& sequence_;
  blocks::WordFormat format_;
  std::uint32_t first_ = 0, end_ = 0;
  std::vector<Group> groups_;
};

void copy_base(const SequenceStrips& strips, BlockForm& form) {
  for (std::uint32_t b = 0; b < strips.block_count(); ++b) {
    const auto slots = strips.block(b);
    form.base_counts.push_back(static_cast<std::uint8_t>(slots.size()));
    form.base_slots.insert(form.base_slots.end(), slots.begin(), slots.end());
  }
}

void append_step_size(std::uint32_t level, std::size_t bytes, BlockForm& form) {
  const bool is_long = bytes >= BlockForm::kLongStep;
  form.step_bytes.push_back(is_long ? BlockForm::kLongStep : static_cast<std::uint8_t>(bytes));
  if (!is_long) return;
  form.long_steps.push_back(level);
  form.long_steps.push_back(static_cast<std::uint32_t>(bytes));
}

}  // namespace

BlockForm build_block_form(const DetailedMesh& detailed, std::uint32_t word_bytes) {
  const CollapseSequence& sequence = detailed.sequence;
  assert(!sequence.moves_vertices());
  const SequenceHistory history(detailed);
  SequenceStrips::FirstCorners first_corners;
  {
    SequenceStrips strips(detailed, history);
    while (strips.level() < sequence.step_count()) strips.split();
    first_corners = strips.first_corners();
  }
  // Three bytes name the blocks of 800,000 vertices; where they do not, begin again with four.
  for (;; ++word_bytes) {
    const blocks::WordFormat format(word_bytes);
    SequenceStrips strips(detailed, history, first_corners);
    BlockForm made;
    made.word_bytes = word_bytes;
    copy_base(strips, made);
    StepWriter writer(sequence, format);
    made.step_bytes.reserve(sequence.step_count());
    for (std::uint32_t level = 0; level < sequence.step_count(); ++level) {
      strips.split();
      const std::size_t before = made.records.size();
      writer.write(level, strips.changes(), made.records);
      append_step_size(level, made.records.size() - before, made);
      if (strips.block_count() > format.block_limit()) break;
    }
    if (strips.block_count() > format.block_limit()) continue;
    SequenceStrips::Layout layout = strips.layout();
    made.first = std::move(layout.first);
    made.buffer_size = layout.size;
    if (detailed.mesh.ranges.size() > 1)
      for (std::uint32_t b = 0; b < strips.block_count(); ++b)
        made.range.push_back(strips.material_range(b));
    made.records.insert(made.records.end(), BlockForm::kPadding, 0);
    made.records.shrink_to_fit();
    return made;
  }
}

}  // namespace varifold
