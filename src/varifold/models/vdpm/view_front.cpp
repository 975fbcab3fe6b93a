#include <varifold/models/vdpm/view_front.h>

#include <varifold/models/vdpm/key_scan.h>
#include <algorithm>
#include <cmath>

namespace varifold {

namespace {

// Keys that are reached always, and never.
constexpr float kAlways = 0;
const ViewAnswer kNever{false, Mover::kNothing, 0};
constexpr std::uint32_t kTendedPerFrame = 8;

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
  steps_.push_back(step);
  keys_.push_back(odometers_.key(Mover::kNothing, 0));
  dependents_.push_back(0);
  flags_.push_back(flags);
  return slot;
}

void ViewFront::remove_slot(std::uint32_t slot) {
  const std::uint32_t last = slot_count() - 1;
  slot_of_[steps_[slot]] = kNone;
  if (slot != last) {
    steps_[slot] = steps_[last];
    keys_[slot] = keys_[last];
    dependents_[slot] = dependents_[last];
    flags_[slot] = flags_[last];
    slot_of_[steps_[slot]] = slot;
  }
  steps_.pop_back();
  keys_.pop_back();
  dependents_.pop_back();
  flags_.pop_back();
}

FrontStatistics ViewFront::adapt(ActiveSurface& surface, const RefineCriteria& criteria,
                                 const AdaptOptions& options, const FrontLimits& limits,
                                 FrontGeomorphs* morphs) {
  Frame frame{surface, morphs, limits, options.max_triangles, {}, {}};
  if (limits.max_microseconds > 0)
    frame.end = std::chrono::steady_clock::now() +
                std::chrono::nanoseconds(static_cast<std::int64_t>(limits.max_microseconds * 1e3f));
  if (begin_frame(criteria, options.tolerance) || limits.schedule != FrontSchedule::kDue) {
    find_due(limits);
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

// The slots that a frame begins with.
void ViewFront::find_due(const FrontLimits& limits) {
  if (limits.schedule == FrontSchedule::kDue) {
    find_due_keys(keys_, odometers_, slots_);
  } else {
    const float part = limits.schedule == FrontSchedule::kAll
                           ? 1.0f
                           : std::clamp(limits.amortized_part, 0.0f, 1.0f);
    const auto count =
        static_cast<std::uint32_t>(std::ceil(part * static_cast<float>(slot_count())));
    slots_.clear();
    for (std::uint32_t i = 0; i < std::min(count, slot_count()); ++i) {
      if (window_ >= slot_count()) window_ = 0;
      slots_.push_back(window_++);
    }
  }
  take_due();
}

// The slots of the steps that have become due, behind those that are there.
void ViewFront::take_due() {
  for (const std::uint32_t step : due_)
    if (slot_of_[step] != kNone) slots_.push_back(slot_of_[step]);
  due_.clear();
}

// Rounds: what is due is sorted by the question that it needs, asked eight at a time, and answered
// by keys; then come the collapses, and when nothing is due any more the splits, which make other
// steps due. Slots keep their places until the collapses.
void ViewFront::settle(Frame& frame) {
  asked_.clear();
  while (!slots_.empty() || !asked_.empty()) {
    while (!slots_.empty()) {
      sort_due();
      ask_nested(frame);
      ask_own(frame);
      for (const std::uint32_t step : leaving_) collapse(step, frame);
      slots_.clear();
      take_due();
    }
    // All that are asked are known by now: of those split along with them the others are forced.
    for (const std::uint32_t step : asked_) flags_[slot_of_[step]] |= kAsked;
    for (const std::uint32_t step : asked_)
      if (!is_split(step)) split(step, frame);
    for (const std::uint32_t step : asked_)
      flags_[slot_of_[step]] &= static_cast<std::uint8_t>(~kAsked);
    asked_.clear();
    take_due();
  }
  tend();
}

// Sorts the slots that are due: to nested_ those whose subtrees are in question, to own_ those that
// are themselves, to leaving_ those that nothing wants any more.
void ViewFront::sort_due() {
  nested_.clear();
  own_.clear();
  leaving_.clear();
  for (const std::uint32_t slot : slots_) {
    if ((flags_[slot] & kWatched) == 0) {
      // Only others can want it: its parent is not asked, so nor is it.
      keep_key(slot, kNever);
      if (dependents_[slot] == 0) leaving_.push_back(steps_[slot]);
    } else if ((flags_[slot] & kExpanded) == 0) {
      model_->prefetch_bounds(steps_[slot]);
      nested_.push_back(slot);
    } else {
      enter_own(slot);
    }
  }
}

void ViewFront::enter_own(std::uint32_t slot) {
  if ((flags_[slot] & kSplit) != 0 && dependents_[slot] != 0) {
    keep_key(slot, kNever);  // until they are gone
  } else {
    model_->prefetch_bounds(steps_[slot]);
    own_.push_back(slot);
  }
}

// Is any step of the subtree asked? If so its children are watched from now on.
void ViewFront::ask_nested(Frame& frame) {
  frame.statistics.tests += static_cast<std::uint32_t>(nested_.size());
  question_.nested(*model_, steps_, nested_, answers_);
  for (std::size_t i = 0; i < nested_.size(); ++i) {
    const std::uint32_t slot = nested_[i];
    if ((flags_[slot] & kExpanded) != 0) continue;  // it was due twice
    if (answers_[i].asked) {
      expand(slot);
      enter_own(slot);
    } else {
      keep_key(slot, answers_[i]);
      if ((flags_[slot] & kSplit) != 0 && dependents_[slot] == 0) leaving_.push_back(steps_[slot]);
    }
  }
}

// Is the step itself asked?
void ViewFront::ask_own(Frame& frame) {
  frame.statistics.tests += static_cast<std::uint32_t>(own_.size());
  keep_.clear();
  for (const std::uint32_t slot : own_)
    keep_.push_back((flags_[slot] & kSplit) != 0 ? frame.limits.hysteresis : 0.0f);
  question_.own(*model_, steps_, own_, keep_, answers_);
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const std::uint32_t slot = own_[i];
    // A key that was found with hysteresis comes no later than it should without.
    keep_key(slot, answers_[i]);
    const bool is_split = (flags_[slot] & kSplit) != 0;
    if (answers_[i].asked == is_split) continue;
    model_->prefetch_record(steps_[slot]);
    (is_split ? leaving_ : asked_).push_back(steps_[slot]);
  }
}

void ViewFront::expand(std::uint32_t slot) {
  flags_[slot] |= kExpanded;
  model_->for_each_watched(steps_[slot], [&](std::uint32_t child) {
    if (slot_of_[child] == kNone)
      add_slot(child, kWatched);
    else
      flags_[slot_of_[child]] |= kWatched;
    due_.push_back(child);
  });
}

bool ViewFront::has_expanded_child(std::uint32_t step) const {
  bool found = false;
  model_->for_each_watched(step, [&](std::uint32_t child) {
    found = found || (flags_[slot_of_[child]] & kExpanded) != 0;
  });
  return found;
}

// Stops watching the children of a step whose subtree nobody asks for any more. Whether that is
// done soon or late changes no front; it keeps the slots few. A step's parent in the watch tree is
// the greatest of those that it requires, so that it may follow.
bool ViewFront::close(std::uint32_t slot) {
  const std::uint32_t step = steps_[slot];
  if ((flags_[slot] & (kExpanded | kSplit)) != kExpanded || has_expanded_child(step)) return false;
  const ViewAnswer answer = question_.nested(model_->bounds(step), model_->center(step));
  if (answer.asked) return false;
  flags_[slot] &= static_cast<std::uint8_t>(~kExpanded);
  keep_key(slot, answer);
  model_->for_each_watched(step, [&](std::uint32_t child) {
    const std::uint32_t at = slot_of_[child];
    flags_[at] &= static_cast<std::uint8_t>(~kWatched);
    keep_key(at, kNever);
    if ((flags_[at] & kSplit) == 0) remove_slot(at);
  });
  return true;
}

// A few slots a frame, in turn, and their ancestors.
void ViewFront::tend() {
  const std::uint32_t count = std::min(slot_count(), kTendedPerFrame + slot_count() / 512);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (window_ >= slot_count()) window_ = 0;
    std::uint32_t step = steps_[window_++];
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
  std::uint8_t& flags = flags_[slot_of_[step]];
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
    flags_[slot] &= static_cast<std::uint8_t>(~kGathered);
    if (flags_[slot] == 0) remove_slot(slot);
  }
}

void ViewFront::split(std::uint32_t step, Frame& frame) {
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
  std::uint8_t& flags = flags_[slot_of_[step]];
  flags = static_cast<std::uint8_t>((flags & ~kGathered) | kSplit);
  if (frame.morphs != nullptr)
    frame.morphs->split(step);
  else
    frame.surface.split(step);
  ++frame.statistics.splits;
  if ((flags & kAsked) == 0) ++frame.statistics.forced_splits;
  model_->for_each_required(step, [&](std::uint32_t required) {
    const std::uint32_t at = slot_of_[required];
    // Only its subtree can still fall due, if that is not expanded.
    if (dependents_[at]++ == 0 && (flags_[at] & (kWatched | kExpanded)) != kWatched)
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
  const std::uint32_t slot = slot_of_[step];
  flags_[slot] &= static_cast<std::uint8_t>(~kSplit);
  model_->for_each_required(step, [&](std::uint32_t required) {
    if (--dependents_[slot_of_[required]] == 0) due_.push_back(required);
  });
  if ((flags_[slot] & kWatched) == 0) remove_slot(slot);
}

void ViewFront::set_level(std::uint32_t level) {
  std::vector<std::uint32_t> slots(steps_);
  for (const std::uint32_t step : slots) slot_of_[step] = kNone;
  steps_.clear();
  keys_.clear();
  dependents_.clear();
  flags_.clear();
  waiting_.clear();
  window_ = 0;
  has_question_ = false;
  for (std::uint32_t step = 0; step < level; ++step) {
    add_slot(step, kSplit);
    model_->for_each_required(step, [&](std::uint32_t r) { ++dependents_[slot_of_[r]]; });
  }
  for (const std::uint32_t root : model_->watch_roots()) {
    const std::uint32_t slot = slot_of_[root] != kNone ? slot_of_[root] : add_slot(root, 0);
    flags_[slot] |= kWatched;
  }
  std::fill(keys_.begin(), keys_.end(), kAlways);
}

std::size_t ViewFront::bytes() const {
  return keys_.capacity() * sizeof(float) + dependents_.capacity() * sizeof(std::uint16_t) +
         flags_.capacity() + keep_.capacity() * sizeof(float) +
         answers_.capacity() * sizeof(ViewAnswer) +
         (steps_.capacity() + slot_of_.capacity() + slots_.capacity() + due_.capacity() +
          leaving_.capacity() + nested_.capacity() + own_.capacity() + asked_.capacity() +
          required_.capacity() + waiting_.capacity()) *
             sizeof(std::uint32_t);
}

}  // namespace varifold
