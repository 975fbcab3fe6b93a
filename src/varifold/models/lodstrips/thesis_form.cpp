// Based on: [Ramos2008] sections 4.2 and 4.3 (records {strip, position, r} per level).
// Differs: a removal takes a pair (strip_slots.h), so that r counts pairs; a step that moves
//   several vertices (wedges of one point) says in r which one; no table of levels, but a flag at
//   the last record of each.
#include <varifold/models/lodstrips/thesis_form.h>

#include <varifold/models/lodstrips/strip_bytes.h>

namespace varifold {

namespace {

using Record = ThesisForm::Record;

bool replay(const Record& record, ChangeChecker& checker) {
  const std::uint32_t position = record.position & ~ThesisForm::kLast;
  if (record.strip == kNone) return position == 0 && record.r == 0;
  if (record.r == 0) return checker.collapse(record.strip, position, 0);
  if (record.r > ThesisForm::kMoved)
    return checker.collapse(record.strip, position,
                            static_cast<std::uint32_t>(record.r - ThesisForm::kMoved));
  if (record.r == ThesisForm::kMoved || record.r <= -ThesisForm::kMoved) return false;
  for (std::int32_t n = record.r > 0 ? record.r : -record.r; n > 0; --n)
    if (!checker.remove(record.strip, position)) return false;
  return true;
}

}  // namespace

std::size_t ThesisForm::bytes() const {
  return strip_bytes(strips) + records.size() * sizeof(Record);
}

void ThesisForm::append_bytes(std::vector<std::byte>& bytes) const {
  append_strips(strips, bytes);
  append_little(bytes, static_cast<std::uint32_t>(records.size()));
  bytes.reserve(bytes.size() + records.size() * sizeof(Record));
  for (const Record& record : records) {
    append_little(bytes, record.strip);
    append_little(bytes, record.position);
    append_little(bytes, record.r);
  }
}

Result<ThesisForm> ThesisForm::take(SectionReader& section, const LevelTable& table,
                                    std::uint32_t material_range_count) {
  ThesisForm form;
  auto strips =
      take_strips(section, table.vertex_count(table.finest_level()), material_range_count);
  if (!strips) return tl::unexpected<Error>(std::move(strips.error()));
  form.strips = std::move(*strips);
  const std::uint32_t count = section.take_count(sizeof(Record));
  form.records.reserve(count);
  ChangeChecker checker(form.strips, table);
  for (std::uint32_t i = 0; i < count; ++i) {
    Record record{};
    record.strip = section.take<std::uint32_t>();
    record.position = section.take<std::uint32_t>();
    record.r = section.take<std::int32_t>();
    if (checker.level() == 0) return section.fault("there are more changes than levels");
    if (!replay(record, checker)) return section.fault("a change does not fit its strip");
    const bool last = (record.position & kLast) != 0;
    if (last && !checker.finish_level())
      return section.fault("a vertex is drawn at a level that has it no more");
    form.records.push_back(record);
  }
  if (!section.good() || checker.level() > 0) return section.fault("the changes end too early");
  return form;
}

}  // namespace varifold
