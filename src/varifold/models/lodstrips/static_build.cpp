// Based on: [Ramos2008] sections 4.2 and 5.5 (see thesis_form.cpp and grouped_form.cpp).
#include <varifold/models/lodstrips/static_build.h>

#include <varifold/models/lodstrips/static_removal.h>
#include <array>
#include <vector>

namespace varifold {

namespace {

using Kind = StripChange::Kind;
using Record = ThesisForm::Record;

void append_change(const StripChange& change, std::size_t level_begin,
                   std::vector<Record>& records) {
  if (change.kind == Kind::kCollapse) {
    const auto moved = static_cast<std::int32_t>(change.moved);
    records.push_back({change.strip, change.position, moved == 0 ? 0 : ThesisForm::kMoved + moved});
    return;
  }
  const std::int32_t sign = change.kind == Kind::kRemoveOne ? 1 : -1;
  if (records.size() > level_begin) {
    Record& last = records.back();
    const bool same_kind = last.r != 0 && last.r < ThesisForm::kMoved && (last.r > 0) == (sign > 0);
    if (same_kind && last.strip == change.strip && last.position == change.position) {
      last.r += sign;
      return;
    }
  }
  records.push_back({change.strip, change.position, sign});
}

// Appends the changes of one step.
class GroupWriter {
 public:
  explicit GroupWriter(GroupedForm& form) : form_(form) {}

  void add(const StripChange& change) {
    const auto kind = static_cast<std::size_t>(change.kind);
    constexpr std::array<std::uint32_t, 3> kMost{(1u << GroupedForm::kCollapseBits) - 1,
                                                 (1u << GroupedForm::kRemoveBits) - 1,
                                                 (1u << GroupedForm::kRemoveBits) - 1};
    const bool collapse = change.kind == Kind::kCollapse;
    const bool fits = open_ && change.strip == strip_ && count_[kind] < kMost[kind] &&
                      (!collapse || (change.moved == moved_ && count_[1] + count_[2] == 0));
    if (!fits) {
      close();
      open_ = true;
      strip_ = change.strip;
      moved_ = collapse ? change.moved : 0;
    }
    ++count_[kind];
    form_.positions.push_back(static_cast<std::uint16_t>(change.position));
  }
  void finish_level() {
    if (!open_) strip_ = moved_ = 0;
    write(GroupedForm::kLast);
  }

 private:
  void close() {
    if (open_) write(0);
  }
  void write(std::uint32_t flags) {
    if (moved_ != 0) form_.moved.push_back(moved_);
    form_.groups.push_back(strip_ | flags | (moved_ != 0 ? GroupedForm::kHasMoved : 0));
    form_.counts.push_back(static_cast<std::uint16_t>(
        count_[0] | count_[1] << GroupedForm::kCollapseBits |
        count_[2] << (GroupedForm::kCollapseBits + GroupedForm::kRemoveBits)));
    count_ = {};
    open_ = false;
  }

  GroupedForm& form_;
  bool open_ = false;
  std::uint32_t strip_ = 0, moved_ = 0;
  std::array<std::uint32_t, 3> count_{};
};

}  // namespace

ThesisForm build_thesis_form(const DetailedMesh& detailed, const TriangleStrips& full_strips) {
  ThesisForm form;
  form.strips = cut_for_removal(detailed, full_strips, kMostStrip);
  StaticRemoval removal(detailed, form.strips);
  while (removal.level() > 0) {
    const std::size_t begin = form.records.size();
    for (const StripChange& change : removal.collapse()) append_change(change, begin, form.records);
    if (form.records.size() == begin) form.records.push_back({kNone, 0, 0});
    form.records.back().position |= ThesisForm::kLast;
  }
  form.records.shrink_to_fit();
  return form;
}

GroupedForm build_grouped_form(const DetailedMesh& detailed, const TriangleStrips& full_strips) {
  GroupedForm form;
  form.strips = cut_for_removal(detailed, full_strips, kMostStrip);
  StaticRemoval removal(detailed, form.strips);
  GroupWriter writer(form);
  while (removal.level() > 0) {
    for (const StripChange& change : removal.collapse()) writer.add(change);
    writer.finish_level();
  }
  form.groups.shrink_to_fit();
  form.counts.shrink_to_fit();
  form.positions.shrink_to_fit();
  form.moved.shrink_to_fit();
  return form;
}

}  // namespace varifold
