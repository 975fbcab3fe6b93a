// The front of a view-dependent mesh: which steps are split, kept up from frame to frame at a cost
// that goes with what changes.
//
// Based on: [Hoppe1997] section 5 (incremental refinement and coarsening, forced splits); the
//   collapse of a step may wait for others as [ElSanaVarshney1999] has it.
// Differs: steps depend on each other by the star rule (docs/algorithms/strip_framework.md), so
// that
//   fronts fold nowhere; a count of dependents tells when a collapse is allowed, instead of looking
//   at neighbours; a decision is looked at when it can change, not each frame.
#pragma once

#include <varifold/models/common/front_model.h>
#include <varifold/models/vdpm/active_surface.h>
#include <varifold/models/vdpm/front_question.h>
#include <varifold/models/vdpm/geomorph.h>
#include <varifold/models/vdpm/odometers.h>
#include <varifold/models/vdpm/view_dependent_mesh.h>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Which decisions a frame looks at.
enum class FrontSchedule : std::uint8_t {
  kDue,        ///< those that may have changed
  kAll,        ///< all of the front [Hoppe1997, section 5]
  kAmortized,  ///< a part of the front each frame, so that the front lags behind
};

struct FrontLimits {
  /// Splits stay until the eye is farther away by this part of the distance than where they came,
  /// so that a trembling camera changes nothing. With 0 the front depends on the question alone.
  float hysteresis = 0;
  std::uint32_t max_changes = kNone;  ///< splits and collapses a frame; the rest waits
  float max_microseconds = 0;         ///< a frame; 0: no limit
  /// With a budget: which part of it may stay unused, so that the tolerance need not be searched in
  /// each frame. With 0 it is the least of tolerance_search.h that fits.
  float unused_budget = 0;
  /// Splits and collapses take so many frames (geomorph.h); up to 1: they are done at once.
  std::uint32_t morph_frames = 0;
  FrontSchedule schedule = FrontSchedule::kDue;
  float amortized_part = 0.25f;  ///< of the front, for kAmortized
};

/// Steps are split or not, watched or not, expanded or not. A step that is asked by the question is
/// split, and all steps that it requires: these are all, when adapt() is done and nothing waits.
/// A step is watched when its parent in the watch tree is expanded; it is expanded when the bounds
/// of its subtree are asked, so that every step that is asked is watched. Every step that is
/// watched or split has a slot, and in it a key: the reading of an odometer at which its decision
/// has to be looked at again.
class ViewFront {
 public:
  explicit ViewFront(const ViewDependentMesh& model);

  /// Splits and collapses until the front is that of the question. At most `max_triangles`
  /// triangles at any time; steps that would be more wait, see FrontStatistics::waiting.
  /// O(slots) with a small constant, O(1) expected for each step looked at and each change; O(1)
  /// when nothing moved. Allocates only where the front is greater than ever before.
  /// With `morphs` these are told all changes, in place of the surface.
  FrontStatistics adapt(ActiveSurface& surface, const RefineCriteria& criteria,
                        const AdaptOptions& options, const FrontLimits& limits,
                        FrontGeomorphs* morphs = nullptr);

  [[nodiscard]] bool is_split(std::uint32_t step) const {
    const std::uint32_t slot = slot_of_[step];
    return slot != kNone && (slots_[slot].flags & kSplit) != 0;
  }
  /// Of the last call of adapt(); null where there was none, or none with a view.
  [[nodiscard]] const ViewQuery* last_view() const {
    return has_question_ && question_.has_view() ? &question_.view() : nullptr;
  }
  [[nodiscard]] std::uint32_t slot_count() const {
    return static_cast<std::uint32_t>(slots_.size());
  }
  /// For a surface that was brought to a uniform level: the steps below it are split. O(steps).
  void set_level(std::uint32_t level);

  [[nodiscard]] std::size_t bytes() const;

 private:
  enum Flag : std::uint8_t { kSplit = 1, kWatched = 2, kExpanded = 4, kGathered = 8, kAsked = 16 };
  struct Slot {
    std::uint32_t step;
    std::uint16_t dependents;  // split steps that require the step
    std::uint8_t flags;
  };
  // So many slots are looked at before any is asked; few enough to stay in the nearest cache.
  static constexpr std::size_t kWindow = 512;
  // Slots to ask about, and their steps.
  struct SlotList {
    std::array<std::uint32_t, 2 * kWindow + 1> slots, steps;  // with room for one in vain
    std::size_t count = 0;

    // Counts the slot only if it `counts`, without a branch.
    void add_if(bool counts, std::uint32_t slot, std::uint32_t step) {
      slots[count] = slot;
      steps[count] = step;
      count += counts ? 1 : 0;
    }
    [[nodiscard]] std::span<const std::uint32_t> all_steps() const { return {steps.data(), count}; }
  };
  struct Frame;

  [[nodiscard]] bool begin_frame(const RefineCriteria& criteria, float tolerance);
  void find_due(Frame& frame);
  void settle(Frame& frame);
  void take_due(Frame& frame);
  void sort(std::uint32_t slot);
  [[nodiscard]] bool has_questions() const { return nested_.count + own_.count > 0; }
  void ask(Frame& frame);
  void ask_if_full(Frame& frame);
  void ask_nested(Frame& frame);
  void ask_own(Frame& frame);
  [[nodiscard]] bool close(std::uint32_t slot);
  void split(std::uint32_t step, Frame& frame);
  [[nodiscard]] std::uint32_t gather_required(std::uint32_t step);
  void gather(std::uint32_t step);
  void let_go();
  void split_one(std::uint32_t step, Frame& frame);
  void collapse(std::uint32_t step, Frame& frame);
  void expand(std::uint32_t slot);
  [[nodiscard]] bool has_expanded_child(std::uint32_t step) const;
  std::uint32_t add_slot(std::uint32_t step, std::uint8_t flags);
  void remove_slot(std::uint32_t slot);
  void keep_key(std::uint32_t slot, const ViewAnswer& answer) {
    keys_[slot] = odometers_.key(answer.mover, answer.slack);
  }
  // It will not fall due.
  void forget_key(std::uint32_t slot) { keys_[slot] = odometers_.key(Mover::kNothing, 0); }
  void tend();

  const ViewDependentMesh* model_;
  Odometers odometers_;
  FrontQuestion question_;
  bool has_question_ = false;
  std::uint32_t window_ = 0;  // where the next part of an amortised frame, or of tend(), begins

  std::uint32_t split_count_ = 0;

  // Per slot.
  std::vector<float> keys_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> slot_of_;  // per step

  // At work.
  SlotList nested_, own_;
  std::vector<std::uint32_t> room_;                              // of key_scan.h
  std::vector<std::uint32_t> due_, leaving_, asked_, required_;  // steps
  std::vector<float> keep_;  // per entry of own_, with hysteresis
  FrontAnswers answers_;
  std::vector<std::uint32_t> waiting_;  // due again in the next frame
};

}  // namespace varifold
