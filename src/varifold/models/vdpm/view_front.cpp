#include <varifold/models/vdpm/view_front.h>

#include <varifold/models/vdpm/key_scan.h>
#include <varifold/models/vdpm/view_front_frame.h>
#include <algorithm>
#include <cmath>

namespace varifold {

namespace {

constexpr float kAlways = 0;  // a key that is due

}  // namespace

ViewFront::ViewFront(const ViewDependentMesh& model)
    : model_(&model), odometers_(model.bounding_ball()), slot_of_(model.step_count(), kNone) {
  for (const std::uint32_t root : model.watch_roots()) keys_[add_slot(root, kWatched)] = kAlways;
}

std::uint32_t ViewFront::add_slot(std::uint32_t step, std::uint8_t flags) {
  const auto slot = slot_count();
  slot_of_[step] = slot;
  slots_.push_back({step, 0, flags});
  keys_.push_back(0);
  forget_key(slot);
  return slot;
}

void ViewFront::remove_slot(std::uint32_t slot) {
  const std::uint32_t last = slot_count() - 1;
  slot_of_[slots_[slot].step] = kNone;
  if (slot != last) {
    slots_[slot] = slots_[last];
    keys_[slot] = keys_[last];
    slot_of_[slots_[slot].step] = slot;
  }
  slots_.pop_back();
  keys_.pop_back();
}

FrontStatistics ViewFront::adapt(ActiveSurface& surface, const RefineCriteria& criteria,
                                 const AdaptOptions& options, const FrontLimits& limits,
                                 FrontGeomorphs* morphs) {
  Frame frame{surface, morphs, limits, options.max_triangles, {}, {}};
  if (limits.max_microseconds > 0)
    frame.end = std::chrono::steady_clock::now() +
                std::chrono::nanoseconds(static_cast<std::int64_t>(limits.max_microseconds * 1e3f));
  if (begin_frame(criteria, options.tolerance) || limits.schedule != FrontSchedule::kDue) {
    find_due(frame);
    settle(frame);
  }
  frame.statistics.vertices = surface.vertex_count();
  frame.statistics.triangles = frame.triangle_count();
  frame.statistics.tolerance = options.tolerance;
  frame.statistics.waiting = static_cast<std::uint32_t>(waiting_.size());
  return frame.statistics;
}

// Moves the odometers on, or makes every key due where they cannot tell what changed. False when
// nothing is due.
bool ViewFront::begin_frame(const RefineCriteria& criteria, float tolerance) {
  due_.clear();
  due_.swap(waiting_);
  const bool begins_anew = !has_question_ || question_.differs_in_kind(criteria, tolerance);
  const float radius = model_->bounding_ball().radius;
  const ViewQuery before = question_.view();
  question_.set(criteria, tolerance, radius, odometers_);
  has_question_ = true;
  bool moved = !due_.empty();
  if (!begins_anew && criteria.view && odometers_.advance(before, question_.view())) moved = true;
  if (begins_anew || odometers_.reach_is_stale() || odometers_.is_worn()) {
    if (odometers_.reach_is_stale()) {
      odometers_.forget();
      question_.set(criteria, tolerance, radius, odometers_);
    }
    odometers_.rebase();
    std::fill(keys_.begin(), keys_.end(), kAlways);
    moved = true;
  }
  return moved;
}

// What a frame begins with. Slots that asking adds are not due.
void ViewFront::find_due(Frame& frame) {
  const std::uint32_t slots = slot_count();
  if (frame.limits.schedule == FrontSchedule::kDue) {
    for (std::uint32_t begin = 0; begin < slots; begin += kWindow) {
      const std::span<const float> keys(&keys_[begin],
                                        std::min<std::size_t>(kWindow, slots - begin));
      for (const std::uint32_t i : find_due_keys(keys, odometers_, room_)) sort(begin + i);
      ask_if_full(frame);
    }
  } else {
    const float part = frame.limits.schedule == FrontSchedule::kAll
                           ? 1.0f
                           : std::clamp(frame.limits.amortized_part, 0.0f, 1.0f);
    const auto count = static_cast<std::uint32_t>(std::ceil(part * static_cast<float>(slots)));
    for (std::uint32_t i = 0; i < std::min(count, slots); ++i) {
      if (window_ >= slots) window_ = 0;
      sort(window_++);
      ask_if_full(frame);
    }
  }
  take_due(frame);
}

// The steps that have become due, and those that do while these are asked.
void ViewFront::take_due(Frame& frame) {
  for (std::size_t i = 0; i < due_.size(); ++i) {
    if (slot_of_[due_[i]] == kNone) continue;
    sort(slot_of_[due_[i]]);
    ask_if_full(frame);
  }
  due_.clear();
}

// Rounds: what is due is sorted by the question that it needs, asked eight at a time, and answered
// by keys; then come the collapses, and when nothing is due any more the splits, which make other
// steps due. Slots keep their places until the collapses.
void ViewFront::settle(Frame& frame) {
  while (has_questions() || !leaving_.empty() || !asked_.empty()) {
    while (has_questions() || !leaving_.empty()) {
      ask(frame);
      for (const std::uint32_t step : leaving_) collapse(step, frame);
      leaving_.clear();
      take_due(frame);
    }
    // All that are asked are known by now: of those split along with them the others are forced.
    for (const std::uint32_t step : asked_) slots_[slot_of_[step]].flags |= kAsked;
    for (const std::uint32_t step : asked_)
      if (!is_split(step)) split(step, frame);
    for (const std::uint32_t step : asked_)
      slots_[slot_of_[step]].flags &= static_cast<std::uint8_t>(~kAsked);
    asked_.clear();
    take_due(frame);
  }
  tend();
}

void ViewFront::ask(Frame& frame) {
  ask_nested(frame);  // some of these ask for themselves then
  ask_own(frame);
}

// So that there is always room for a window more.
void ViewFront::ask_if_full(Frame& frame) {
  if (nested_.count + own_.count > kWindow) ask(frame);
}

// A slot that is due goes to nested_ if its subtree is in question, to own_ if it is itself, to
// leaving_ if nothing wants it any more.
void ViewFront::sort(std::uint32_t slot) {
  const Slot& at = slots_[slot];
  if ((at.flags & kWatched) == 0) {
    // Only others can want it: its parent is not asked, so nor is it.
    forget_key(slot);
    if (at.dependents == 0) leaving_.push_back(at.step);
    return;
  }
  const bool is_expanded = (at.flags & kExpanded) != 0;
  const bool is_held = is_expanded & ((at.flags & kSplit) != 0) & (at.dependents != 0);
  if (is_held) forget_key(slot);  // until they are gone
  model_->prefetch_bounds(at.step);
  nested_.add_if(!is_expanded, slot, at.step);
  own_.add_if(is_expanded & !is_held, slot, at.step);
}

// Is any step of the subtree asked? If so its children are watched from now on.
void ViewFront::ask_nested(Frame& frame) {
  frame.statistics.tests += static_cast<std::uint32_t>(nested_.count);
  question_.nested(*model_, odometers_, nested_.all_steps(), answers_);
  for (std::size_t i = 0; i < nested_.count; ++i) {
    const std::uint32_t slot = nested_.slots[i];
    if ((slots_[slot].flags & kExpanded) != 0) continue;  // it was due twice
    if (answers_.asked[i] != 0) {
      expand(slot);
      sort(slot);
    } else {
      keys_[slot] = answers_.keys[i];
      const Slot& at = slots_[slot];
      if ((at.flags & kSplit) != 0 && at.dependents == 0) leaving_.push_back(at.step);
    }
  }
  nested_.count = 0;
}

// Is the step itself asked?
void ViewFront::ask_own(Frame& frame) {
  frame.statistics.tests += static_cast<std::uint32_t>(own_.count);
  keep_.clear();
  if (frame.limits.hysteresis > 0)
    for (std::size_t i = 0; i < own_.count; ++i)
      keep_.push_back((slots_[own_.slots[i]].flags & kSplit) != 0 ? frame.limits.hysteresis : 0);
  question_.own(*model_, odometers_, own_.all_steps(), keep_, answers_);
  for (std::size_t i = 0; i < own_.count; ++i) {
    const std::uint32_t slot = own_.slots[i];
    // A key that was found with hysteresis comes no later than it should without.
    keys_[slot] = answers_.keys[i];
    const Slot& at = slots_[slot];
    const bool is_split = (at.flags & kSplit) != 0;
    if ((answers_.asked[i] != 0) == is_split) continue;
    model_->prefetch_record(at.step);
    (is_split ? leaving_ : asked_).push_back(at.step);
  }
  own_.count = 0;
}

void ViewFront::set_level(std::uint32_t level) {
  for (const Slot& slot : slots_) slot_of_[slot.step] = kNone;
  slots_.clear();
  keys_.clear();
  waiting_.clear();
  window_ = 0;
  has_question_ = false;
  split_count_ = level;
  for (std::uint32_t step = 0; step < level; ++step) {
    add_slot(step, kSplit);
    model_->for_each_required(step, [&](std::uint32_t r) { ++slots_[slot_of_[r]].dependents; });
  }
  for (const std::uint32_t root : model_->watch_roots()) {
    const std::uint32_t slot = slot_of_[root] != kNone ? slot_of_[root] : add_slot(root, 0);
    slots_[slot].flags |= kWatched;
  }
  std::fill(keys_.begin(), keys_.end(), kAlways);
}

std::size_t ViewFront::bytes() const {
  return (keys_.capacity() + keep_.capacity()) * sizeof(float) + slots_.capacity() * sizeof(Slot) +
         answers_.bytes() +
         (slot_of_.capacity() + room_.capacity() + due_.capacity() + leaving_.capacity() +
          asked_.capacity() + required_.capacity() + waiting_.capacity()) *
             sizeof(std::uint32_t);
}

}  // namespace varifold
