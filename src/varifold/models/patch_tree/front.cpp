#include <varifold/models/patch_tree/front.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace varifold {

namespace {

using Clock = std::chrono::steady_clock;

// The clock is read once in so many splits.
constexpr std::uint32_t kSplitsPerTick = 16;

bool same_options(const PatchFrontOptions& a, const PatchFrontOptions& b) {
  return a.limits.tolerance == b.limits.tolerance &&
         a.limits.max_triangles == b.limits.max_triangles && a.measure == b.measure;
}

// So much wider a window of priorities must be for a part more triangles; a guess.
float window_of(std::uint64_t missing, std::uint64_t triangles) {
  const double part = static_cast<double>(missing) / static_cast<double>(triangles + 1);
  return static_cast<float>(std::clamp(1.5 * part, 0.01, 4.0));
}

}  // namespace

struct PatchFront::Frame {
  Frame(const PatchFrontOptions& from, float last_cut)
      : options(&from), tolerance(std::max(from.limits.tolerance, 0.0f)) {
    has_budget = from.limits.max_triangles != kNone;
    budget = has_budget ? from.limits.max_triangles : std::numeric_limits<std::uint64_t>::max();
    wanted_above = has_budget ? std::max(tolerance, last_cut) : tolerance;
    has_time = from.max_microseconds > 0;
    if (has_time)
      end = Clock::now() +
            std::chrono::nanoseconds(static_cast<std::int64_t>(from.max_microseconds * 1e3f));
  }

  const PatchFrontOptions* options;
  float tolerance, wanted_above = 0;  // all with greater priorities than the latter are wanted
  bool has_budget = false, has_time = false;
  std::uint64_t budget = 0;
  Clock::time_point end;
  std::uint32_t splits = 0, turns = 0, not_resident = 0;
  FrontStop stop = FrontStop::kTolerance;
  float stopped_at = 0;  // the priority of the first node that was not split
  float cut = 0;         // and of the first that is not wanted
};

PatchFront::PatchFront(std::shared_ptr<const FrontTables> tables)
    : tables_(std::move(tables)),
      set_(*tables_),
      queue_(tables_->inner_count()),
      draws_(*tables_) {}

// False where nothing can be different from the last call.
bool PatchFront::begin(const RefineCriteria& criteria, const PatchFrontOptions& options) {
  const bool differs = priorities_.set(criteria, options.measure);
  const bool may_stay = is_settled_ && options.resident.are_resident == nullptr &&
                        options_.resident.are_resident == nullptr &&
                        same_options(options, options_);
  options_ = options;
  queue_.clear();
  return differs || !may_stay;
}

PatchFrontResult PatchFront::adapt_split_only(const RefineCriteria& criteria,
                                              const PatchFrontOptions& options) {
  (void)begin(criteria, options);
  Frame frame(options, 0);
  set_.reset();
  set_.evaluate(priorities_);
  for (std::uint32_t root = 0; root < std::min(tables_->root_count(), tables_->inner_count());
       ++root)
    if (set_.priority(root) > frame.tolerance) queue_.push(set_.priority(root), root);
  frame.stop = run_queue(frame, {frame.budget, frame.tolerance});
  frame.cut = frame.stop == FrontStop::kTolerance ? frame.tolerance : frame.stopped_at;
  return end(frame);
}

void PatchFront::go_to_level(std::uint32_t level) {
  set_.reset();
  const PatchTopology& topology = tables_->topology();
  const std::uint32_t end =
      topology.level_count() == 0
          ? 0
          : topology.first_of_level[std::min(level, topology.level_count() - 1)];
  for (std::uint32_t node = 0; node < end; ++node) {
    set_.split(node, priorities_);
    set_.want(node);
  }
  is_settled_ = false;
  draws_.follow(set_);
}

// What is no longer wanted is merged, what is wanted is split: above the priority where the last
// call stopped. From there the budget is met.
PatchFrontResult PatchFront::adapt(const RefineCriteria& criteria,
                                   const PatchFrontOptions& options) {
  Frame frame(options, cut_);
  if (!begin(criteria, options)) {
    draws_.follow(set_);
    result_.statistics.splits = result_.statistics.collapses = 0;
    return result_;
  }
  set_.evaluate(priorities_);
  set_.keep_above(frame.wanted_above, options.resident);
  split_wanted(frame);
  if (set_.triangles() > frame.budget)
    coarsen(frame);
  else if (frame.stop == FrontStop::kTolerance && frame.wanted_above > frame.tolerance)
    refine(frame);
  return end(frame);
}

// Splits all that is wanted and is not split, unless there is so much of it that less must be
// wanted. The budget may be exceeded by a part.
void PatchFront::split_wanted(Frame& frame) {
  found_.clear();
  set_.collect_unsplit(frame.wanted_above, found_);
  for (const std::uint32_t node : found_) queue_.push(set_.priority(node), node);
  const std::uint64_t limit = frame.has_budget ? frame.budget + frame.budget / 8 : frame.budget;
  frame.stop = run_queue(frame, {limit, frame.wanted_above});
  frame.cut = frame.wanted_above;
  if (frame.stop != FrontStop::kTriangles) return;
  // All with greater priorities are split, but so are some with smaller ones.
  queue_.clear();
  frame.stop = FrontStop::kTolerance;
  frame.wanted_above = frame.cut = frame.stopped_at;
  set_.keep_above(frame.wanted_above, frame.options->resident);
}

// Wants less and less, in ascending order, until the budget is met.
void PatchFront::coarsen(Frame& frame) {
  float width = window_of(set_.triangles() - frame.budget, set_.triangles());
  float from = frame.wanted_above;
  while (set_.triangles() > frame.budget && from < std::numeric_limits<float>::infinity()) {
    const float to = std::max(from, 1e-12f) * (1 + width);
    found_.clear();
    set_.collect_wanted(from, to, found_);
    keys_.clear();
    for (const std::uint32_t node : found_) keys_.push_back(front_key(set_.priority(node), node));
    std::make_heap(keys_.begin(), keys_.end(), std::greater<>());
    while (!keys_.empty() && set_.triangles() > frame.budget) {
      std::pop_heap(keys_.begin(), keys_.end(), std::greater<>());
      const std::uint32_t node = node_of(keys_.back());
      keys_.pop_back();
      set_.unwant(node);
      frame.cut = set_.priority(node);
    }
    from = to;
    width *= 2;
  }
  if (set_.triangles() > frame.budget) {
    stop_at_roots(frame);
  } else if (frame.stop == FrontStop::kTolerance) {
    frame.stop = FrontStop::kTriangles;
  }
}

// Nothing is split, and still there are too many triangles: which root would be the first?
void PatchFront::stop_at_roots(Frame& frame) {
  frame.cut = frame.tolerance;
  for (std::uint32_t root = 0; root < std::min(tables_->root_count(), tables_->inner_count());
       ++root) {
    if (set_.priority(root) <= frame.cut || !set_.gather(root, frame.options->resident)) continue;
    frame.cut = set_.priority(root);
    if (frame.stop == FrontStop::kTolerance) frame.stop = FrontStop::kTriangles;
  }
}

// Wants more and more, in descending order, until the next one would exceed the budget.
void PatchFront::refine(Frame& frame) {
  float width = window_of(frame.budget - set_.triangles(), set_.triangles());
  float from = frame.wanted_above;
  while (frame.stop == FrontStop::kTolerance && from > frame.tolerance) {
    const float finite = std::min(from, std::numeric_limits<float>::max());
    const float to = std::max(frame.tolerance, finite / (1 + width));
    found_.clear();
    set_.collect_unwanted(to, from, found_);
    for (const std::uint32_t node : found_) queue_.push(set_.priority(node), node);
    frame.stop = run_queue(frame, {frame.budget, to});
    from = to;
    width *= 2;
  }
  frame.cut = frame.stop == FrontStop::kTolerance ? frame.tolerance : frame.stopped_at;
}

// Splits what is in the queue, and the children with priorities above the floor, until it is empty
// or a limit is reached.
FrontStop PatchFront::run_queue(Frame& frame, const Budget& budget) {
  const PatchFrontOptions& options = *frame.options;
  while (!queue_.empty()) {
    const std::uint32_t node = queue_.pop();
    if (!set_.is_split(node)) {
      if (!set_.gather(node, options.resident)) {
        ++frame.not_resident;
        continue;
      }
      const auto count = static_cast<std::uint32_t>(set_.chain().size());
      FrontStop stop = FrontStop::kTolerance;
      if (set_.triangles() + set_.chain_growth() > budget.triangles) stop = FrontStop::kTriangles;
      if (options.max_splits - frame.splits < count) stop = FrontStop::kSplits;
      if (frame.has_time && ++frame.turns % kSplitsPerTick == 0 && Clock::now() >= frame.end)
        stop = FrontStop::kTime;
      if (stop != FrontStop::kTolerance) {
        frame.stopped_at = set_.priority(node);
        return stop;
      }
      frame.splits += count;
      split_chain(budget.floor);
    }
    set_.want(node);
  }
  return FrontStop::kTolerance;
}

void PatchFront::split_chain(float floor) {
  const PatchTopology& topology = tables_->topology();
  for (const std::uint32_t node : set_.chain()) {
    set_.split(node, priorities_);
    const std::uint32_t first = topology.first_child[node], end = topology.first_child[node + 1];
    if (first >= tables_->inner_count()) continue;
    for (std::uint32_t child = first; child < end; ++child)
      if (set_.priority(child) > floor) queue_.push(set_.priority(child), child);
  }
}

PatchFrontResult PatchFront::end(const Frame& frame) {
  const bool is_cut = frame.stop != FrontStop::kTolerance;
  cut_ = frame.cut;
  is_settled_ = frame.stop == FrontStop::kTolerance || frame.stop == FrontStop::kTriangles;
  draws_.follow(set_);
  result_.stop = frame.stop;
  result_.is_over_budget = set_.triangles() > frame.budget;
  result_.not_resident = frame.not_resident;
  FrontStatistics& statistics = result_.statistics;
  statistics.splits = draws_.splits();
  statistics.collapses = draws_.merges();
  statistics.forced_splits = set_.forced_count();
  statistics.vertices = static_cast<std::uint32_t>(draws_.vertices());
  statistics.triangles = static_cast<std::uint32_t>(draws_.triangles());
  statistics.tolerance = cut_;
  statistics.waiting = is_cut ? queue_.size() + 1 : 0;
  statistics.refused = frame.stop == FrontStop::kTriangles ? statistics.waiting : 0;
  return result_;
}

std::size_t PatchFront::bytes() const {
  return set_.bytes() + draws_.bytes() + queue_.bytes() +
         found_.capacity() * sizeof(std::uint32_t) + keys_.capacity() * sizeof(FrontKey);
}

}  // namespace varifold
