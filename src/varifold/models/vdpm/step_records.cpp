#include <varifold/models/vdpm/step_records.h>

#include <algorithm>
#include <cassert>

namespace varifold {

namespace {

// What a record in the long form says instead of counts.
constexpr std::uint8_t kHere = 0, kFar = 1;

}  // namespace

void StepRecords::begin(std::uint32_t vertices, std::uint32_t triangles, std::uint32_t steps,
                        bool triangles_in_order) {
  *this = {};
  triangles_in_order_ = triangles_in_order;
  const bool narrow = vertices < 1u << 21u && triangles < 1u << 22u && steps < 1u << 24u;
  word_bytes_ = narrow ? 3 : 4;
  word_mask_ = narrow ? 0xffffffu : 0xffffffffu;
  assert(vertices < 1u << 29u && triangles < 1u << 30u);
  groups_.reserve(steps / 8 + 1);
  bytes_.reserve(std::size_t{steps} * 28);
}

void StepRecords::push(std::vector<std::uint8_t>& bytes, std::uint32_t word,
                       std::uint32_t count) const {
  for (std::uint32_t i = 0; i < count; ++i)
    bytes.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
}

std::uint32_t StepRecords::order_code(const StepChange::Added& added, std::uint32_t vertex,
                                      std::uint32_t target) {
  for (std::uint32_t code = 0; code < 6; ++code) {
    const auto& order = kOrders[code];
    bool fits = true;
    for (std::size_t c = 0; c < 3; ++c)
      fits = fits && (order[c] == 2 || added.corners[c] == (order[c] == 0 ? vertex : target));
    if (fits) return code;
  }
  return 6;
}

bool StepRecords::has_short_form(const StepChange& step, std::uint32_t vertex,
                                 std::uint32_t target) {
  return step.required.size() < 16 && step.watched.size() < 16 && step.changed.size() < 16 &&
         step.added.size() < 8 &&
         std::all_of(step.changed.begin(), step.changed.end(),
                     [&](const StepChange::Corner& c) { return c.vertex == vertex; }) &&
         std::all_of(step.added.begin(), step.added.end(), [&](const StepChange::Added& added) {
           return order_code(added, vertex, target) < 6;
         });
}

void StepRecords::append(const StepChange& step, std::uint32_t vertex, std::uint32_t target) {
  std::vector<std::uint8_t> record;
  if (has_short_form(step, vertex, target)) {
    record = {static_cast<std::uint8_t>(step.required.size() | step.changed.size() << 4u),
              static_cast<std::uint8_t>(step.watched.size() | step.added.size() << 4u)};
    for (const std::uint32_t k : step.required) push(record, k, word_bytes_);
    for (const std::uint32_t k : step.watched) push(record, k, word_bytes_);
    for (const auto& c : step.changed) push(record, c.triangle << 2u | c.corner, word_bytes_);
    for (const auto& added : step.added) {
      const std::uint32_t code = order_code(added, vertex, target);
      const auto& order = kOrders[code];
      const auto other =
          static_cast<std::size_t>(std::find(order.begin(), order.end(), 2) - order.begin());
      push(record, added.corners[other] << 3u | code, word_bytes_);
      if (!triangles_in_order_) push(record, added.triangle, word_bytes_);
    }
  } else {
    record = {kHere, kForm};
    append_long(step, record);
  }
  if (record.size() > kLongest) {
    const auto place = static_cast<std::uint32_t>(far_.size());
    // Always in the long form: the short one has no counts of its own there.
    std::vector<std::uint8_t> body;
    append_long(step, body);
    far_.insert(far_.end(), body.begin(), body.end());
    record = {kFar, kForm};
    push(record, place, 4);
  }
  if (count_ % 8 == 0) groups_.push_back({static_cast<std::uint32_t>(bytes_.size()), {}});
  groups_.back().sizes[count_ % 8] = static_cast<std::uint8_t>(record.size());
  bytes_.insert(bytes_.end(), record.begin(), record.end());
  ++count_;
}

void StepRecords::append_long(const StepChange& step, std::vector<std::uint8_t>& record) const {
  push(record, static_cast<std::uint32_t>(step.required.size()), 4);
  push(record, static_cast<std::uint32_t>(step.watched.size()), 4);
  push(record, static_cast<std::uint32_t>(step.changed.size()), 4);
  push(record, static_cast<std::uint32_t>(step.added.size()), 4);
  for (const std::uint32_t k : step.required) push(record, k, word_bytes_);
  for (const std::uint32_t k : step.watched) push(record, k, word_bytes_);
  for (const auto& c : step.changed) {
    push(record, c.triangle << 2u | c.corner, word_bytes_);
    push(record, c.vertex, word_bytes_);
  }
  for (const auto& added : step.added) {
    push(record, added.triangle, word_bytes_);
    for (const std::uint32_t v : added.corners) push(record, v, word_bytes_);
  }
}

void StepRecords::finish() {
  for (std::vector<std::uint8_t>* bytes : {&bytes_, &far_}) {
    bytes->resize(bytes->size() + 4, 0);  // load() reads a whole word
    bytes->shrink_to_fit();
  }
  groups_.shrink_to_fit();
}

StepRecords::View StepRecords::find_long(const std::uint8_t* at) const {
  const std::uint8_t* counts = at[0] == kFar ? far_.data() + load(at + 2) : at + 2;
  View view;
  view.is_short = false;
  view.required = load(counts);
  view.watched = load(counts + 4);
  view.changed = load(counts + 8);
  view.added = load(counts + 12);
  view.words = counts + 16;
  return view;
}

}  // namespace varifold
