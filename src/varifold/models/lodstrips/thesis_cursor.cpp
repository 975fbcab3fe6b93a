// Based on: [Ramos2008] section 4.4 (recovery strips and draw strips; figures 4.4 and 4.5).
// Differs: going up takes levels, and the records of each, in the opposite order of going down.
#include <varifold/models/lodstrips/thesis_cursor.h>

#include <algorithm>

namespace varifold {

using Record = ThesisForm::Record;

ThesisCursor::ThesisCursor(const ThesisForm& form, const LevelTable& table,
                           const TriangleMesh& attributes)
    : form_(form),
      table_(table),
      level_(table.finest_level()),
      vertex_count_(table.vertex_count(level_)),
      recovery_(form.strips),
      draw_(form.strips.indices),
      is_modified_(form.strips.count(), 0),
      ranges_(form.strips, attributes) {
  modified_.reserve(form.strips.count());
  changed_.reset(draw_.size());
}

void ThesisCursor::go_to_level(std::uint32_t level) {
  level = std::min(level, table_.finest_level());
  while (level_ > level) collapse();
  while (level_ < level) split();
}

void ThesisCursor::mark(std::uint32_t strip) {
  if (is_modified_[strip]) return;
  is_modified_[strip] = 1;
  modified_.push_back(strip);
}

void ThesisCursor::collapse() {
  --level_;
  vertex_count_ -= table_.step(level_).vertices;
  for (bool more = true; more;) {
    const Record& record = form_.records[cursor_++];
    const std::uint32_t position = record.position & ~ThesisForm::kLast;
    more = (record.position & ThesisForm::kLast) == 0;
    if (record.strip == kNone) continue;
    mark(record.strip);
    if (record.r == 0 || record.r > ThesisForm::kMoved) {
      const std::uint32_t vertex = recovery_.at(record.strip, position);
      recovery_.set(record.strip, position, table_.target(vertex));
    } else {
      const std::uint32_t before = recovery_.length(record.strip);
      for (std::int32_t n = record.r > 0 ? record.r : -record.r; n > 0; --n)
        recovery_.remove(record.strip, position);
      ranges_.resize(record.strip, before, recovery_.length(record.strip));
    }
  }
}

void ThesisCursor::split() {
  while (true) {
    const Record& record = form_.records[--cursor_];
    const std::uint32_t position = record.position & ~ThesisForm::kLast;
    if (record.strip != kNone) {
      mark(record.strip);
      if (record.r == 0 || record.r > ThesisForm::kMoved) {
        const std::uint32_t moved =
            record.r == 0 ? 0 : static_cast<std::uint32_t>(record.r - ThesisForm::kMoved);
        recovery_.set(record.strip, position, vertex_count_ + moved);
      } else {
        const std::uint32_t before = recovery_.length(record.strip);
        for (std::int32_t n = record.r > 0 ? record.r : -record.r; n > 0; --n)
          recovery_.restore(record.strip, position);
        ranges_.resize(record.strip, before, recovery_.length(record.strip));
      }
    }
    if (cursor_ == 0 || (form_.records[cursor_ - 1].position & ThesisForm::kLast) != 0) break;
  }
  vertex_count_ += table_.step(level_).vertices;
  ++level_;
}

void ThesisCursor::fill(DrawList& list) {
  for (const std::uint32_t strip : modified_) {
    // The whole place, so that what stands behind the end is the same from everywhere.
    const std::uint32_t first = recovery_.first(strip), count = recovery_.capacity(strip);
    std::copy_n(recovery_.indices().data() + first, count, draw_.data() + first);
    changed_.mark(first, count);
    is_modified_[strip] = 0;
  }
  modified_.clear();
  list.indices = draw_;
  list.ranges = ranges_.ranges();
  list.changed_indices = changed_.take();
}

std::size_t ThesisCursor::bytes() const {
  return recovery_.bytes() + draw_.size() * sizeof(std::uint32_t) + is_modified_.size() +
         modified_.capacity() * sizeof(std::uint32_t) + ranges_.bytes() + changed_.bytes();
}

}  // namespace varifold
