#include <varifold/models/lodstrips/block_check.h>

#include <varifold/models/lodstrips/block_records.h>
#include <varifold/view/draw_list.h>
#include <algorithm>
#include <array>
#include <numeric>

namespace varifold {

namespace {

constexpr std::uint32_t kMaxSlots = BlockForm::kMaxSlots;

class Checker {
 public:
  Checker(const BlockForm& form, const LevelTable& levels)
      : form_(form), levels_(levels), live_(levels.vertex_count(0)) {
    used_slots_.assign(form.buffer_size, false);
    slots_.assign(form.buffer_size, kStripRestart);
    counts_.assign(form.first.size(), 0);
  }

  const char* check() {
    if (const char* fault = check_steps()) return fault;
    if (!load_base()) return "the base does not fit";
    std::size_t at = 0;
    for (std::uint32_t level = 0; level < levels_.finest_level(); ++level) {
      const std::uint32_t size = form_.size_of_step(level);
      first_vertex_ = live_;
      live_ += levels_.step(level).vertices;
      if (!play(form_.records.data() + at, form_.records.data() + at + size))
        return "a change of a block is impossible";
      at += size;
    }
    return used_ == counts_.size() ? nullptr : "a block is never used";
  }

 private:
  const char* check_steps() {
    if (form_.word_bytes != 3 && form_.word_bytes != 4) return "unknown size of block numbers";
    for (const std::uint32_t first : form_.first)
      if (first >= form_.buffer_size) return "a block begins behind the buffer";
    if (form_.long_steps.size() % 2 != 0) return "a long step has no size";
    std::uint64_t sum = 0;
    std::size_t next_long = 0;
    for (std::uint32_t level = 0; level < form_.step_bytes.size(); ++level) {
      if (form_.step_bytes[level] != BlockForm::kLongStep) {
        sum += form_.step_bytes[level];
        continue;
      }
      if (next_long == form_.long_steps.size() || form_.long_steps[next_long] != level)
        return "a long step has no size";
      sum += form_.long_steps[next_long + 1];
      next_long += 2;
    }
    if (next_long != form_.long_steps.size()) return "there are more long steps than steps";
    if (sum != form_.records.size() - BlockForm::kPadding)
      return "the sizes of the steps are wrong";
    return nullptr;
  }

  bool load_base() {
    if (form_.base_counts.size() > counts_.size()) return false;
    std::size_t at = 0;
    for (const std::uint8_t count : form_.base_counts) {
      block_ = used_++;
      if (count > kMaxSlots) return false;
      for (std::uint32_t i = 0; i < count; ++i, ++at) {
        const std::uint32_t value = form_.base_slots[at];
        if (value != kStripRestart && value >= live_) return false;
        if (!insert(i, value)) return false;
      }
    }
    return true;
  }

  bool play(const std::uint8_t* at, const std::uint8_t* end) {
    const blocks::WordFormat format(form_.word_bytes);
    while (at < end) {
      if (end - at < static_cast<std::ptrdiff_t>(format.bytes)) return false;
      const blocks::Group group(at, format);
      at += format.bytes;
      const std::uint32_t least = group.duplicates + group.sets + (group.rest == 0 ? 0 : 1);
      if (end - at < static_cast<std::ptrdiff_t>(least)) return false;
      const std::uint8_t* const group_end = group.end(at);
      if (group_end > end || !play_group(group, at, group_end)) return false;
      at = group_end;
    }
    return true;
  }

  bool play_group(const blocks::Group& group, const std::uint8_t* at, const std::uint8_t* end) {
    block_ = group.block;
    vertex_ = first_vertex_;
    for (std::uint32_t i = 0; i < group.duplicates; ++i)
      if (block_ >= used_ || !play_simple(blocks::kDuplicate, *at++)) return false;
    for (std::uint32_t i = 0; i < group.sets; ++i)
      if (block_ >= used_ || !play_simple(blocks::kSet, *at++)) return false;
    switch (group.rest) {
      case blocks::kNothing:
        return true;
      case blocks::kMixed:
        return play_mixed(at + 1, end);
      case blocks::kTargetInserted:
        return block_ < used_ && play_simple(blocks::kInsertTarget, *at);
      case blocks::kVertexInserted:
        return block_ < used_ && play_simple(blocks::kInsertTarget, *at) &&
               play_simple(blocks::kSet, *at);
      case blocks::kOpened:
      case blocks::kOpenedHigh: {
        const std::uint32_t order = (*at & 3u) + (group.rest == blocks::kOpenedHigh ? 4 : 0);
        return block_ < used_ && open_copy(order, *at >> 2u);
      }
      default:
        return false;
    }
  }

  bool play_mixed(const std::uint8_t* at, const std::uint8_t* end) {
    while (at < end) {
      const std::uint32_t kind = *at & 3u, detail = *at >> 2u;
      ++at;
      if (kind == blocks::kExtended) {
        if (detail >= blocks::kExtendedCount || end - at < blocks::kPayload[detail]) return false;
        if (!play_extended(detail, at)) return false;
        at += blocks::kPayload[detail];
      } else if (block_ >= used_ || !play_simple(kind, detail)) {
        return false;
      }
    }
    return true;
  }

  bool play_simple(std::uint32_t kind, std::uint32_t slot) {
    const std::uint32_t target = levels_.target(vertex_);
    switch (kind) {
      case blocks::kSet:
        if (slot >= counts_[block_] || this->slot(slot) != target) return false;
        this->slot(slot) = vertex_;
        return true;
      case blocks::kDuplicate: {
        if (slot + 1 >= counts_[block_]) return false;
        const std::uint32_t a = this->slot(slot), b = this->slot(slot + 1);
        return insert(slot + 2, a) && insert(slot + 3, b);
      }
      default:
        return insert(slot, target);
    }
  }

  bool play_extended(std::uint32_t what, const std::uint8_t* at) {
    if (what == blocks::kNewBlock) {
      // The number must be that of the block, and empty blocks stay where no other is.
      return block_ == used_ && used_++ < counts_.size();
    }
    if (block_ >= used_) return false;
    const std::uint32_t count = counts_[block_];
    switch (what) {
      case blocks::kAdvance:
        vertex_ += at[0];
        return vertex_ < live_;
      case blocks::kFirst:
        vertex_ = first_vertex_;
        return true;
      case blocks::kOpenCopy:
        return open_copy(at[0], at[1]);
      case blocks::kOpenValue:
        return open(at[0], blocks::load_value(at + 1));
      case blocks::kInsertCopy:
        return at[1] < count && insert(at[0], slot(at[1]));
      case blocks::kInsertRestart:
        return insert(at[0], kStripRestart);
      case blocks::kInsertValue: {
        const std::uint32_t value = blocks::load_value(at + 1);
        return value < live_ && insert(at[0], value);
      }
      case blocks::kRotateOne:
      case blocks::kRotateTwo: {
        if (at[0] + 2u >= count) return false;
        std::uint32_t* const three = &slot(at[0]);
        std::rotate(three, three + (what == blocks::kRotateOne ? 1 : 2), three + 3);
        return true;
      }
      case blocks::kReverse:
        if (std::uint32_t{at[0]} + at[1] > count) return false;
        std::reverse(&slot(at[0]), &slot(at[0]) + at[1]);
        return true;
      case blocks::kSplitBetween:
        return split(at[0], false);
      case blocks::kSplitInside:
        return split(at[0], true);
      case blocks::kAssignCopy:
        return at[1] < count && assign(at[0], slot(at[1]));
      case blocks::kAssignValue:
        return assign(at[0], blocks::load_value(at + 1));
      default:
        return false;
    }
  }

  std::uint32_t& slot(std::uint32_t i) { return slots_[form_.first[block_] + i]; }

  bool insert(std::uint32_t at, std::uint32_t value) {
    std::uint32_t& count = counts_[block_];
    const std::uint64_t end = std::uint64_t{form_.first[block_]} + count;
    if (at > count || count == kMaxSlots || end >= form_.buffer_size || used_slots_[end])
      return false;
    used_slots_[end] = true;
    for (std::uint32_t i = count; i > at; --i) slot(i) = slot(i - 1);
    slot(at) = value;
    ++count;
    return true;
  }

  bool open_copy(std::uint32_t order, std::uint32_t from) {
    return from < counts_[block_] && open(order, slot(from));
  }

  bool open(std::uint32_t order, std::uint32_t value) {
    if (order >= 6 || value >= live_) return false;
    std::uint32_t& count = counts_[block_];
    if (count > 0 && !insert(count, kStripRestart)) return false;
    std::array<std::uint32_t, 3> slots{};
    const std::uint32_t place = order / 2;
    const bool target_first = order % 2 == 1;
    const std::uint32_t target = levels_.target(vertex_);
    slots[place] = value;
    slots[place == 0 ? 1 : 0] = target_first ? target : vertex_;
    slots[place == 2 ? 1 : 2] = target_first ? vertex_ : target;
    return insert(count, slots[0]) && insert(count, slots[1]) && insert(count, slots[2]);
  }

  bool assign(std::uint32_t at, std::uint32_t value) {
    if (at + 1 >= counts_[block_] || slot(at) != slot(at + 1) || value >= live_) return false;
    slot(at) = value;
    return true;
  }

  bool split(std::uint32_t at, bool inside) {
    const std::uint32_t count = counts_[block_];
    if (at == 0 || at >= count || used_ == counts_.size()) return false;
    if (inside ? at + 2 > count : slot(at - 1) != kStripRestart) return false;
    const std::uint32_t first = form_.first[block_];
    const std::uint32_t left = inside ? at + 2 : at - 1;
    const std::vector<std::uint32_t> moved(slots_.begin() + first + at,
                                           slots_.begin() + first + count);
    for (std::uint32_t i = left; i < count; ++i) {
      used_slots_[first + i] = false;
      slots_[first + i] = kStripRestart;
    }
    counts_[block_] = left;
    const std::uint32_t old = block_;
    block_ = used_++;
    for (const std::uint32_t value : moved)
      if (!insert(counts_[block_], value)) return false;
    block_ = old;
    return true;
  }

  const BlockForm& form_;
  const LevelTable& levels_;
  std::uint32_t live_, first_vertex_ = 0, vertex_ = 0, block_ = 0, used_ = 0;
  std::vector<bool> used_slots_;
  std::vector<std::uint32_t> slots_, counts_;
};

}  // namespace

const char* check_block_form(const BlockForm& form, const LevelTable& levels) {
  return Checker(form, levels).check();
}

}  // namespace varifold
