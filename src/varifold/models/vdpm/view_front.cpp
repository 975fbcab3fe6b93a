#include <varifold/models/vdpm/view_front.h>

#include <varifold/models/vdpm/key_scan.h>
#include <algorithm>
#include <cmath>

namespace varifold {

namespace {

// Keys that are reached always, and never.
constexpr float kAlways = 0;
const ViewAnswer kNever{false, Mover::kNothing, 0};
constexpr std::uint32_t kTendedPerFrame = 4;
constexpr std::uint32_t kManySlots = 5;  // for each step that is split; two to four are common

}  // namespace

// What one call of adapt() carries along.
struct ViewFront::Frame {
  ActiveSurface& surface;
  FrontGeomorphs* morphs;  // or null
  const FrontLimits& limits;
  std::uint32_t max_triangles;
  FrontStatistics statistics;
  std::chrono::steady_clock::time_point end;

  [[nodiscard]] std::uint32_t triangle_count() const {
    return morphs != nullptr ? morphs->triangle_count() : surface.triangle_count();
  }
  // Whether another change is within the limits.
  [[nodiscard]] bool may_change() {
    const std::uint32_t changes = statistics.splits + statistics.collapses;
    if (changes >= limits.max_changes) return false;
    if (limits.max_microseconds <= 0) return true;
    if (changes % 16 == 0) in_time = std::chrono::steady_clock::now() < end;
    return in_time;
  }
  bool in_time = true;
};

ViewFront::ViewFront(const ViewDependentMesh& model)
    : model_(&model), odometers_(model.bounding_ball()), slot_of_(model.step_count(), kNone) {
  for (const std::uint32_t root : model.watch_roots()) keys_[add_slot(root, kWatched)] = kAlways;
}

std::uint32_t ViewFront::add_slot(std::uint32_t step, std::uint8_t flags) {
  const auto slot = slot_count();
  slot_of_[step] = slot;
  slots_.push_back({step, 0, flags});
  keys_.push_back(odometers_.key(Mover::kNothing, 0));
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
    keep_key(slot, kNever);
    if (at.dependents == 0) leaving_.push_back(at.step);
    return;
  }
  const bool is_expanded = (at.flags & kExpanded) != 0;
  const bool is_held = is_expanded & ((at.flags & kSplit) != 0) & (at.dependents != 0);
  if (is_held) keep_key(slot, kNever);  // until they are gone
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

void ViewFront::expand(std::uint32_t slot) {
  slots_[slot].flags |= kExpanded;
  model_->for_each_watched(slots_[slot].step, [&](std::uint32_t child) {
    if (slot_of_[child] == kNone)
      add_slot(child, kWatched);
    else
      slots_[slot_of_[child]].flags |= kWatched;
    due_.push_back(child);
  });
}

bool ViewFront::has_expanded_child(std::uint32_t step) const {
  bool found = false;
  model_->for_each_watched(step, [&](std::uint32_t child) {
    found = found || (slots_[slot_of_[child]].flags & kExpanded) != 0;
  });
  return found;
}

// Stops watching the children of a step whose subtree nobody asks for any more. Whether that is
// done soon or late changes no front; it keeps the slots few. A step's parent in the watch tree is
// the greatest of those that it requires, so that it may follow.
bool ViewFront::close(std::uint32_t slot) {
  const std::uint32_t step = slots_[slot].step;
  if ((slots_[slot].flags & (kExpanded | kSplit)) != kExpanded || has_expanded_child(step))
    return false;
  const ViewAnswer answer = question_.nested(model_->bounds(step), model_->center(step));
  if (answer.asked) return false;
  slots_[slot].flags &= static_cast<std::uint8_t>(~kExpanded);
  keep_key(slot, answer);
  model_->for_each_watched(step, [&](std::uint32_t child) {
    const std::uint32_t at = slot_of_[child];
    slots_[at].flags &= static_cast<std::uint8_t>(~kWatched);
    keep_key(at, kNever);
    if ((slots_[at].flags & kSplit) == 0) remove_slot(at);
  });
  return true;
}

// A few slots a frame, in turn, and their ancestors; more where a front has left many behind.
void ViewFront::tend() {
  const std::uint32_t part = slot_count() / kManySlots > split_count_ ? 16 : 512;
  const std::uint32_t count = std::min(slot_count(), kTendedPerFrame + slot_count() / part);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (window_ >= slot_count()) window_ = 0;
    std::uint32_t step = slots_[window_++].step;
    while (step != kNone && close(slot_of_[step])) {
      std::uint32_t parent = kNone;
      model_->for_each_required(step, [&](std::uint32_t required) {
        if (parent == kNone || required > parent) parent = required;
      });
      step = parent;
    }
  }
}

// A step that is to be split before another one; once.
void ViewFront::gather(std::uint32_t step) {
  if (slot_of_[step] == kNone) add_slot(step, 0);
  std::uint8_t& flags = slots_[slot_of_[step]].flags;
  if ((flags & (kSplit | kGathered)) != 0) return;
  flags |= kGathered;
  required_.push_back(step);
}

// `step` and all that have to be split before it, coarse ones first, in required_; returns how many
// triangles they add.
std::uint32_t ViewFront::gather_required(std::uint32_t step) {
  required_.clear();
  gather(step);
  std::uint32_t triangles = 0;
  for (std::size_t i = 0; i < required_.size(); ++i) {
    triangles += model_->levels().step(required_[i]).triangles;
    model_->for_each_required(required_[i], [&](std::uint32_t r) { gather(r); });
  }
  std::sort(required_.begin(), required_.end());
  return triangles;
}

// Forgets what was gathered.
void ViewFront::let_go() {
  for (const std::uint32_t step : required_) {
    const std::uint32_t slot = slot_of_[step];
    slots_[slot].flags &= static_cast<std::uint8_t>(~kGathered);
    if (slots_[slot].flags == 0) remove_slot(slot);
  }
}

void ViewFront::split(std::uint32_t step, Frame& frame) {
  if (frame.statistics.refused > 0) {
    // The budget does not hold what is asked: whoever asks will ask for less.
    ++frame.statistics.refused;
    waiting_.push_back(step);
    return;
  }
  const std::uint32_t triangles = gather_required(step);
  const bool fits =
      triangles <= frame.max_triangles && frame.triangle_count() <= frame.max_triangles - triangles;
  if (!fits || !frame.may_change()) {
    let_go();
    if (!fits) ++frame.statistics.refused;
    waiting_.push_back(step);
    return;
  }
  for (const std::uint32_t r : required_) split_one(r, frame);
}

void ViewFront::split_one(std::uint32_t step, Frame& frame) {
  std::uint8_t& flags = slots_[slot_of_[step]].flags;
  flags = static_cast<std::uint8_t>((flags & ~kGathered) | kSplit);
  if (frame.morphs != nullptr)
    frame.morphs->split(step);
  else
    frame.surface.split(step);
  ++frame.statistics.splits;
  ++split_count_;
  if ((flags & kAsked) == 0) ++frame.statistics.forced_splits;
  model_->for_each_required(step, [&](std::uint32_t required) {
    const std::uint32_t at = slot_of_[required];
    // Only its subtree can still fall due, if that is not expanded.
    if (slots_[at].dependents++ == 0 && (slots_[at].flags & (kWatched | kExpanded)) != kWatched)
      keep_key(at, kNever);
  });
}

void ViewFront::collapse(std::uint32_t step, Frame& frame) {
  if (!is_split(step)) return;  // it was due twice
  if (!frame.may_change()) {
    waiting_.push_back(step);
    return;
  }
  if (frame.morphs != nullptr)
    frame.morphs->collapse(step);
  else
    frame.surface.collapse(step);
  ++frame.statistics.collapses;
  --split_count_;
  const std::uint32_t slot = slot_of_[step];
  slots_[slot].flags &= static_cast<std::uint8_t>(~kSplit);
  model_->for_each_required(step, [&](std::uint32_t required) {
    if (--slots_[slot_of_[required]].dependents == 0) due_.push_back(required);
  });
  if ((slots_[slot].flags & kWatched) == 0) remove_slot(slot);
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
