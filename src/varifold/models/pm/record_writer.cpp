#include <varifold/models/pm/record_writer.h>

#include <algorithm>

namespace varifold::pm {

void RecordWriter::write(const StreamState& state, SplitRecord& record, BitWriter& bits) {
  state_ = &state;
  bits_ = &bits;
  record_ = &record;
  choose_kind();
  bits.bits(record.kind == SplitRecord::Kind::kPlain ? 0 : 1, 1);
  if (record.kind != SplitRecord::Kind::kPlain) {
    bits.bits(record.kind == SplitRecord::Kind::kExplicit ? 1 : 0, 1);
    write_number(CodeModels::kWedgeCount, static_cast<std::uint32_t>(record.wedges.size()) - 1);
  }
  write_wedges();
  if (record.kind == SplitRecord::Kind::kExplicit)
    write_explicit_triangles();
  else
    write_predicted_triangles();
  write_vertices();
  if (state.moves_vertices) write_placed();
  write_number(CodeModels::kErrorDrop, record.error_drop);
}

void RecordWriter::write_number(std::uint16_t model, std::uint32_t value) {
  state_->models.model[model].write(value, *bits_);
  record_->lessons.push_back({model, value});
}

namespace {

bool same_triangles(std::vector<NewTriangle> a, std::vector<NewTriangle> b) {
  const auto by_range = [](const NewTriangle& x, const NewTriangle& y) {
    return x.range < y.range;
  };
  std::stable_sort(a.begin(), a.end(), by_range);
  std::stable_sort(b.begin(), b.end(), by_range);
  return a == b;
}

}  // namespace

void RecordWriter::choose_kind() {
  if (!predict()) {
    record_->kind = SplitRecord::Kind::kExplicit;
    return;
  }
  const bool plain = record_->wedges.size() == 1 && record_->wedges[0].leads &&
                     record_->wedges[0].closes && record_->triangles == predicted_;
  record_->kind = plain ? SplitRecord::Kind::kPlain : SplitRecord::Kind::kFan;
}

// Sets the flags that give the triangles of the record and puts those in their order, if any do.
bool RecordWriter::predict() {
  const std::vector<NewTriangle>& actual = record_->triangles;
  const std::uint32_t first = state_->surface.vertex_count();
  predicted_.clear();
  std::vector<NewTriangle> matched;
  for (std::uint32_t i = 0; i < record_->wedges.size(); ++i) {
    SplitWedge& wedge = record_->wedges[i];
    for (bool SplitWedge::*flag : {&SplitWedge::leads, &SplitWedge::closes}) {
      SplitWedge alone = wedge;
      alone.leads = alone.closes = false;
      alone.*flag = true;
      wedge.*flag = false;
      const std::size_t size = predicted_.size();
      if (!state_->surface.predict_triangles(*record_, alone, first + i, predicted_)) continue;
      const auto found = std::find_if(actual.begin(), actual.end(), [&](const NewTriangle& t) {
        return t.corners == predicted_[size].corners;
      });
      if (found == actual.end()) {
        predicted_.resize(size);
        continue;
      }
      wedge.*flag = true;
      matched.push_back(*found);
    }
  }
  if (matched.size() != actual.size()) return false;
  if (!same_triangles(matched, actual)) {
    if (matched.size() != 2) return false;
    std::swap(matched[0], matched[1]);
    std::swap(predicted_[0], predicted_[1]);
    if (!same_triangles(matched, actual)) return false;
  }
  record_->triangles = matched;
  return true;
}

void RecordWriter::write_wedges() {
  for (std::size_t i = 0; i < record_->wedges.size(); ++i) {
    const SplitWedge& wedge = record_->wedges[i];
    if (i == 0)
      bits_->uniform(wedge.target, state_->surface.vertex_count());
    else
      write_number(CodeModels::kTargetDelta, zigzag(wedge.target - record_->wedges[i - 1].target));
    write_mask(wedge);
    if (record_->kind != SplitRecord::Kind::kFan) continue;
    bits_->bits(wedge.leads ? 1 : 0, 1);
    bits_->bits(wedge.closes ? 1 : 0, 1);
  }
}

// One bit for every slot of the target that no earlier wedge took.
void RecordWriter::write_mask(const SplitWedge& wedge) {
  SplitRecord earlier;
  for (const SplitWedge& other : record_->wedges) {
    if (&other == &wedge) break;
    earlier.wedges.push_back(other);
  }
  earlier.moved = record_->moved;
  const auto slots = state_->surface.free_slots(earlier, wedge.target, scratch_);
  std::uint32_t next = wedge.first_moved;
  for (const std::uint32_t slot : slots) {
    const bool moves = next < wedge.end_moved && record_->moved[next] == slot;
    bits_->bits(moves ? 1 : 0, 1);
    if (moves) ++next;
  }
}

void RecordWriter::write_predicted_triangles() {
  const std::vector<NewTriangle>& triangles = record_->triangles;
  if (triangles.size() == 2) {
    // The reader expects the wedges in order, and the leading triangle of each first.
    predicted_.clear();
    std::uint32_t vertex = state_->surface.vertex_count();
    for (const SplitWedge& wedge : record_->wedges)
      static_cast<void>(state_->surface.predict_triangles(*record_, wedge, vertex++, predicted_));
    const bool swapped = predicted_[0].corners != triangles[0].corners;
    if (swapped) std::swap(predicted_[0], predicted_[1]);
    bits_->bits(swapped ? 1 : 0, 1);
  }
  const std::uint32_t ranges = state_->surface.range_count();
  if (record_->kind == SplitRecord::Kind::kPlain || ranges == 1) return;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const bool differs = triangles[i].range != predicted_[i].range;
    bits_->bits(differs ? 1 : 0, 1);
    if (differs) bits_->uniform(triangles[i].range, ranges);
  }
}

void RecordWriter::write_explicit_triangles() {
  const std::uint32_t vertices = state_->surface.vertex_count();
  const auto wedges = static_cast<std::uint32_t>(record_->wedges.size());
  write_number(CodeModels::kTriangleCount, static_cast<std::uint32_t>(record_->triangles.size()));
  for (const NewTriangle& triangle : record_->triangles) {
    if (state_->surface.range_count() > 1)
      bits_->uniform(triangle.range, state_->surface.range_count());
    for (const std::uint32_t corner : triangle.corners) {
      std::uint32_t of_record = corner >= vertices ? corner - vertices : 2 * wedges;
      for (std::uint32_t i = 0; i < wedges && of_record == 2 * wedges; ++i)
        if (record_->wedges[i].target == corner) of_record = wedges + i;
      const bool known = of_record < 2 * wedges;
      bits_->bits(known ? 1 : 0, 1);
      bits_->uniform(known ? of_record : corner, known ? 2 * wedges : vertices);
    }
  }
}

void RecordWriter::write_channels(const Prediction& prediction, std::uint32_t first,
                                  const Codes& codes) {
  for (std::uint32_t c = first; c < state_->coder.channel_count(); ++c)
    write_number(prediction.model[c], zigzag(codes[c] - prediction.codes[c]));
}

void RecordWriter::write_vertices() {
  for (std::uint32_t i = 0; i < record_->wedges.size(); ++i) {
    const Codes& codes = record_->codes[i];
    const Prediction prediction = predict_vertex(*state_, *record_, i, scratch_);
    bool same_position = false;
    if (i > 0) {
      same_position = std::equal(codes.begin(), codes.begin() + 3, record_->codes[0].begin());
      bits_->bits(same_position ? 1 : 0, 1);
    }
    write_channels(prediction, same_position ? 3 : 0, codes);
  }
}

void RecordWriter::write_placed() {
  predict_placed_vertices(*record_, scratch_);
  const std::vector<std::uint32_t>& vertices = record_->placed_vertices;
  const bool expected = scratch_ == vertices;
  bits_->bits(expected ? 0 : 1, 1);
  if (!expected) {
    write_number(CodeModels::kPlacedCount, static_cast<std::uint32_t>(vertices.size()));
    for (const std::uint32_t vertex : vertices)
      bits_->uniform(vertex, state_->surface.vertex_count());
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Codes& new_codes = record_->codes[split_off(*record_, vertices[i])];
    write_channels(state_->coder.predict_placed(state_->codes_of(vertices[i]), new_codes), 0,
                   record_->placed_codes[i]);
  }
}

}  // namespace varifold::pm
