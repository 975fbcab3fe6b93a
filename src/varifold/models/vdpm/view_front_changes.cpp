// What a front watches, splits and collapses.
#include <varifold/models/vdpm/view_front.h>

#include <varifold/models/vdpm/view_front_frame.h>
#include <algorithm>

namespace varifold {

namespace {

constexpr std::uint32_t kTendedPerFrame = 4;
constexpr std::uint32_t kManySlots = 5;  // for each step that is split; two to four are common

}  // namespace

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
    forget_key(at);
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
      forget_key(at);
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

}  // namespace varifold
