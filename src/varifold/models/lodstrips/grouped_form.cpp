// Based on: [Ramos2008] section 5.5 (changes grouped by strip, figure 5.4).
// Differs: the three numbers of a group share 16 bits, positions have 16 bits, and there are no
//   pointers, but four arrays that are walked in step.
#include <varifold/models/lodstrips/grouped_form.h>

#include <varifold/models/lodstrips/strip_bytes.h>

namespace varifold {

namespace {

bool replay(const GroupedForm& form, std::size_t group, std::size_t& position, std::size_t& moved,
            ChangeChecker& checker) {
  const std::uint32_t strip = form.groups[group] & GroupedForm::kStripMask;
  std::uint32_t vertex = 0;
  if ((form.groups[group] & GroupedForm::kHasMoved) != 0) {
    if (moved == form.moved.size()) return false;
    vertex = form.moved[moved++];
  }
  const std::uint32_t collapses = GroupedForm::collapses(form.counts[group]);
  const std::uint32_t all = collapses + GroupedForm::removals(form.counts[group]);
  if (all > form.positions.size() - position) return false;
  for (std::uint32_t i = 0; i < all; ++i) {
    const std::uint32_t at = form.positions[position++];
    if (!(i < collapses ? checker.collapse(strip, at, vertex) : checker.remove(strip, at)))
      return false;
  }
  return true;
}

}  // namespace

std::size_t GroupedForm::bytes() const {
  return strip_bytes(strips) + (groups.size() + moved.size()) * sizeof(std::uint32_t) +
         (counts.size() + positions.size()) * sizeof(std::uint16_t);
}

void GroupedForm::append_bytes(std::vector<std::byte>& bytes) const {
  append_strips(strips, bytes);
  for (const std::size_t size : {groups.size(), positions.size(), moved.size()})
    append_little(bytes, static_cast<std::uint32_t>(size));
  append_array<std::uint32_t>(bytes, groups);
  append_array<std::uint16_t>(bytes, counts);
  append_array<std::uint16_t>(bytes, positions);
  append_array<std::uint32_t>(bytes, moved);
}

Result<GroupedForm> GroupedForm::take(SectionReader& section, const LevelTable& table,
                                      std::uint32_t material_range_count) {
  GroupedForm form;
  auto strips =
      take_strips(section, table.vertex_count(table.finest_level()), material_range_count);
  if (!strips) return tl::unexpected<Error>(std::move(strips.error()));
  form.strips = std::move(*strips);
  const auto group_count = section.take<std::uint32_t>();
  const auto position_count = section.take<std::uint32_t>();
  const auto moved_count = section.take<std::uint32_t>();
  form.groups = section.take_array<std::uint32_t>(group_count);
  form.counts = section.take_array<std::uint16_t>(group_count);
  form.positions = section.take_array<std::uint16_t>(position_count);
  form.moved = section.take_array<std::uint32_t>(moved_count);
  if (!section.good()) return section.fault("the changes end too early");
  ChangeChecker checker(form.strips, table);
  std::size_t position = 0, moved = 0;
  for (std::size_t group = 0; group < group_count; ++group) {
    if (checker.level() == 0) return section.fault("there are more changes than levels");
    if (!replay(form, group, position, moved, checker))
      return section.fault("a change does not fit its strip");
    if ((form.groups[group] & kLast) != 0 && !checker.finish_level())
      return section.fault("a vertex is drawn at a level that has it no more");
  }
  if (checker.level() > 0) return section.fault("the changes end too early");
  if (position != position_count || moved != moved_count)
    return section.fault("there are more changes than levels");
  return form;
}

}  // namespace varifold
