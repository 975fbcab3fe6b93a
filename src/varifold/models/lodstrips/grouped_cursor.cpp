// Based on: [Ramos2008] section 5.6 (one element buffer; offsets and counts for one draw call).
// Differs: strips are changed in memory and what has changed is named for upload; nothing is read
//   back from the GPU.
#include <varifold/models/lodstrips/grouped_cursor.h>

#include <algorithm>

namespace varifold {

GroupedCursor::GroupedCursor(const GroupedForm& form, const LevelTable& table,
                             const TriangleMesh& attributes)
    : form_(form),
      table_(table),
      level_(table.finest_level()),
      vertex_count_(table.vertex_count(level_)),
      slots_(form.strips),
      counts_(form.strips.count(), 0),
      ranges_(form.strips, attributes) {
  offsets_.reserve(form.strips.count());
  for (std::uint32_t s = 0; s < form.strips.count(); ++s) {
    offsets_.push_back(form.strips.first[s] * sizeof(std::uint32_t));
    const std::uint32_t length = slots_.length(s);
    counts_[s] = length < kLeastStrip ? 0 : static_cast<std::int32_t>(length);
  }
  changed_.reset(form.strips.indices.size());
}

void GroupedCursor::go_to_level(std::uint32_t level) {
  level = std::min(level, table_.finest_level());
  while (level_ > level) collapse();
  while (level_ < level) split();
}

void GroupedCursor::resize(std::uint32_t strip, std::uint32_t before) {
  const std::uint32_t length = slots_.length(strip);
  if (length == before) return;
  counts_[strip] = length < kLeastStrip ? 0 : static_cast<std::int32_t>(length);
  ranges_.resize(strip, before, length);
}

void GroupedCursor::collapse() {
  --level_;
  vertex_count_ -= table_.step(level_).vertices;
  std::uint32_t group = 0;
  do {
    group = form_.groups[group_];
    const std::uint16_t counts = form_.counts[group_++];
    if (counts == 0) continue;
    const std::uint32_t strip = group & GroupedForm::kStripMask;
    std::uint32_t vertex = vertex_count_;
    if ((group & GroupedForm::kHasMoved) != 0) vertex += form_.moved[moved_++];
    const std::uint32_t target = table_.target(vertex);
    const std::uint16_t* position = form_.positions.data() + position_;
    const std::uint16_t* removals = position + GroupedForm::collapses(counts);
    const std::uint16_t* end = removals + GroupedForm::removals(counts);
    while (position < removals) slots_.set(strip, *position++, target);
    const std::uint32_t before = slots_.length(strip);
    while (position < end) slots_.remove(strip, *position++);
    resize(strip, before);
    position_ = static_cast<std::size_t>(end - form_.positions.data());
    changed_.mark(slots_.first(strip), slots_.capacity(strip));
  } while ((group & GroupedForm::kLast) == 0);
}

void GroupedCursor::split() {
  do {
    const std::uint32_t group = form_.groups[--group_];
    const std::uint16_t counts = form_.counts[group_];
    if (counts == 0) continue;
    const std::uint32_t strip = group & GroupedForm::kStripMask;
    std::uint32_t vertex = vertex_count_;
    if ((group & GroupedForm::kHasMoved) != 0) vertex += form_.moved[--moved_];
    const std::uint16_t* position = form_.positions.data() + position_;
    const std::uint16_t* removals = position - GroupedForm::removals(counts);
    const std::uint16_t* begin = removals - GroupedForm::collapses(counts);
    const std::uint32_t before = slots_.length(strip);
    while (position > removals) slots_.restore(strip, *--position);
    resize(strip, before);
    while (position > begin) slots_.set(strip, *--position, vertex);
    position_ = static_cast<std::size_t>(begin - form_.positions.data());
    changed_.mark(slots_.first(strip), slots_.capacity(strip));
  } while (group_ > 0 && (form_.groups[group_ - 1] & GroupedForm::kLast) == 0);
  vertex_count_ += table_.step(level_).vertices;
  ++level_;
}

void GroupedCursor::fill(DrawList& list) {
  list.indices = slots_.indices();
  list.ranges = ranges_.ranges();
  list.changed_indices = changed_.take();
}

std::size_t GroupedCursor::bytes() const {
  return slots_.bytes() + counts_.size() * sizeof(std::int32_t) +
         offsets_.size() * sizeof(std::size_t) + ranges_.bytes() + changed_.bytes();
}

}  // namespace varifold
