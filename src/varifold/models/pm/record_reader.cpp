#include <varifold/models/pm/record_reader.h>

#include <varifold/models/pm/record_limits.h>
#include <algorithm>

namespace varifold::pm {

const char* RecordReader::read(const StreamState& state, BitReader& bits, SplitRecord& record) {
  state_ = &state;
  bits_ = &bits;
  record_ = &record;
  record.clear();
  if (const char* fault = read_connectivity()) return fault;
  if (bits.exhausted()) return nullptr;
  read_vertices();
  if (state.moves_vertices)
    if (const char* fault = read_placed()) return fault;
  record.error_drop = read_number(CodeModels::kErrorDrop);
  return record.error_drop <= state.error ? nullptr : "the error falls below zero";
}

std::uint32_t RecordReader::read_number(std::uint16_t model) {
  const std::uint32_t value = state_->models.model[model].read(*bits_);
  record_->lessons.push_back({model, value});
  return value;
}

const char* RecordReader::read_connectivity() {
  if (bits_->bits(1) == 0) {
    record_->kind = SplitRecord::Kind::kPlain;
    if (const char* fault = read_wedges(1, false)) return fault;
    record_->wedges[0].leads = record_->wedges[0].closes = true;
    return read_predicted_triangles(true);
  }
  const bool is_explicit = bits_->bits(1) == 1;
  record_->kind = is_explicit ? SplitRecord::Kind::kExplicit : SplitRecord::Kind::kFan;
  const std::uint32_t more_wedges = read_number(CodeModels::kWedgeCount);
  if (more_wedges >= kMaxWedges) return "too many new vertices in one split";
  if (const char* fault = read_wedges(more_wedges + 1, !is_explicit)) return fault;
  return is_explicit ? read_explicit_triangles() : read_predicted_triangles(false);
}

const char* RecordReader::read_wedges(std::uint32_t count, bool with_flags) {
  const std::uint32_t vertices = state_->surface.vertex_count();
  for (std::uint32_t i = 0; i < count; ++i) {
    SplitWedge wedge;
    wedge.target =
        i == 0 ? bits_->uniform(vertices)
               : record_->wedges[i - 1].target + unzigzag(read_number(CodeModels::kTargetDelta));
    if (wedge.target >= vertices) return "a target is no vertex";
    if (const char* fault = read_mask(wedge)) return fault;
    if (with_flags) {
      wedge.leads = bits_->bits(1) == 1;
      wedge.closes = bits_->bits(1) == 1;
    }
    record_->wedges.push_back(wedge);
    if (bits_->exhausted()) break;
  }
  return nullptr;
}

const char* RecordReader::read_mask(SplitWedge& wedge) {
  const auto slots = state_->surface.free_slots(*record_, wedge.target, scratch_);
  wedge.first_moved = static_cast<std::uint32_t>(record_->moved.size());
  for (std::size_t i = 0; i < slots.size() && !bits_->exhausted(); i += 32) {
    const auto count = static_cast<unsigned>(std::min<std::size_t>(32, slots.size() - i));
    for (std::uint32_t mask = bits_->bits(count); mask != 0; mask &= mask - 1) {
      const std::uint32_t slot = slots[i + static_cast<unsigned>(std::countr_zero(mask))];
      state_->surface.prefetch(slot);
      record_->moved.push_back(slot);
    }
  }
  wedge.end_moved = static_cast<std::uint32_t>(record_->moved.size());
  return wedge.end_moved <= kMaxSlots ? nullptr : "too many corners move in one split";
}

namespace {

bool has_equal_corners(const NewTriangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  return a == b || b == c || a == c;
}

}  // namespace

const char* RecordReader::read_predicted_triangles(bool plain) {
  std::vector<NewTriangle>& triangles = record_->triangles;
  std::uint32_t vertex = state_->surface.vertex_count();
  for (const SplitWedge& wedge : record_->wedges)
    if (!state_->surface.predict_triangles(*record_, wedge, vertex++, triangles))
      return "no corner that moves tells the new triangles";
  if (triangles.size() > kMaxTriangles) return "too many triangles in one split";
  if (triangles.size() == 2 && bits_->bits(1) == 1) std::swap(triangles[0], triangles[1]);

  const std::uint32_t ranges = state_->surface.range_count();
  for (NewTriangle& triangle : triangles) {
    if (!plain && ranges > 1 && bits_->bits(1) == 1) triangle.range = bits_->uniform(ranges);
    if (has_equal_corners(triangle)) return "a new triangle has two equal corners";
  }
  return nullptr;
}

const char* RecordReader::read_explicit_triangles() {
  const std::uint32_t vertices = state_->surface.vertex_count();
  const std::uint32_t ranges = state_->surface.range_count();
  const auto wedges = static_cast<std::uint32_t>(record_->wedges.size());
  const std::uint32_t count = read_number(CodeModels::kTriangleCount);
  if (count > kMaxTriangles) return "too many triangles in one split";
  for (std::uint32_t i = 0; i < count && !bits_->exhausted(); ++i) {
    NewTriangle triangle;
    if (ranges > 1) triangle.range = bits_->uniform(ranges);
    for (std::uint32_t& corner : triangle.corners) {
      if (bits_->bits(1) == 0) {
        corner = bits_->uniform(vertices);
        continue;
      }
      const std::uint32_t of_record = bits_->uniform(2 * wedges);
      corner =
          of_record < wedges ? vertices + of_record : record_->wedges[of_record - wedges].target;
    }
    if (has_equal_corners(triangle)) return "a new triangle has two equal corners";
    record_->triangles.push_back(triangle);
  }
  return nullptr;
}

void RecordReader::read_channels(const Prediction& prediction, std::uint32_t first, Codes& codes) {
  for (std::uint32_t c = first; c < state_->coder.channel_count(); ++c)
    codes[c] = prediction.codes[c] + unzigzag(read_number(prediction.model[c]));
}

void RecordReader::read_vertices() {
  for (std::uint32_t i = 0; i < record_->wedges.size(); ++i) {
    const Prediction prediction = predict_vertex(*state_, *record_, i, scratch_);
    Codes codes = prediction.codes;
    const bool same_position = i > 0 && bits_->bits(1) == 1;
    read_channels(prediction, same_position ? 3 : 0, codes);
    record_->codes.push_back(codes);
  }
}

const char* RecordReader::read_placed() {
  std::vector<std::uint32_t>& vertices = record_->placed_vertices;
  if (bits_->bits(1) == 0) {
    predict_placed_vertices(*record_, vertices);
  } else {
    const std::uint32_t all = state_->surface.vertex_count();
    const std::uint32_t count = read_number(CodeModels::kPlacedCount);
    if (count > all) return "more vertices move in one split than there are";
    for (std::uint32_t i = 0; i < count && !bits_->exhausted(); ++i)
      vertices.push_back(bits_->uniform(all));
    scratch_ = vertices;
    std::sort(scratch_.begin(), scratch_.end());
    if (std::adjacent_find(scratch_.begin(), scratch_.end()) != scratch_.end())
      return "a vertex moves twice in one split";
  }
  if (bits_->exhausted()) return nullptr;
  for (const std::uint32_t vertex : vertices) {
    const Codes& new_codes = record_->codes[split_off(*record_, vertex)];
    const Prediction prediction = state_->coder.predict_placed(state_->codes_of(vertex), new_codes);
    Codes codes = prediction.codes;
    read_channels(prediction, 0, codes);
    record_->placed_codes.push_back(codes);
  }
  return nullptr;
}

}  // namespace varifold::pm
