#include <varifold/partition/border_smoothing.h>

#include <varifold/base/parallel.h>
#include <varifold/partition/border_stretches.h>
#include <varifold/partition/path_mover.h>
#include <algorithm>
#include <atomic>
#include <bit>
#include <vector>

namespace varifold {

namespace {

constexpr std::size_t kGrain = 64;
constexpr std::uint64_t kBlockTriangles = 1u << 14;  // what is known of them stays in a cache
// Never met: every step shortens.
constexpr std::uint32_t kMaxRounds = 1000;
constexpr std::uint32_t kMaxSteps = 1u << 20;

// The order of work: stretches inside a block of patches, all blocks at once, then those between
// blocks in sets that have no patch in common.
struct WorkPlan {
  std::vector<std::vector<std::uint32_t>> blocks;
  std::vector<std::vector<std::uint32_t>> sets;
};

WorkPlan plan_work(const std::vector<Stretch>& stretches, std::uint32_t patch_count,
                   std::uint32_t patches_per_block) {
  WorkPlan plan;
  plan.blocks.resize(patch_count / patches_per_block + 1);
  constexpr int kSets = 64;
  plan.sets.resize(kSets);
  std::vector<std::uint64_t> taken(patch_count, 0);
  for (std::uint32_t s = 0; s < stretches.size(); ++s) {
    const Stretch& stretch = stretches[s];
    if (stretch.a / patches_per_block == stretch.b / patches_per_block) {
      plan.blocks[stretch.a / patches_per_block].push_back(s);
      continue;
    }
    const int set = std::countr_one(taken[stretch.a] | taken[stretch.b]);
    if (set == kSets) {
      plan.sets.push_back({s});  // by itself
      continue;
    }
    taken[stretch.a] |= std::uint64_t{1} << set;
    taken[stretch.b] |= std::uint64_t{1} << set;
    plan.sets[set].push_back(s);
  }
  std::erase_if(plan.sets, [](const auto& set) { return set.empty(); });
  return plan;
}

class Smoother {
 public:
  Smoother(PatchedSurface& patched, const SmoothedPatches& patches)
      : patched_(patched),
        max_triangles_(patches.max_triangles),
        sizes_(patches.count, 0),
        checked_at_(patched.borders.stretches.size(), 0),
        is_blocked_(patched.borders.stretches.size(), 1),
        changed_at_(patches.count, 1) {
    for (const std::uint32_t patch : patches.patch_of) ++sizes_[patch];
  }

  // Returns whether there was anything to look at.
  bool run(const WorkPlan& plan, int threads) {
    std::atomic<bool> found{false};
    std::vector<std::uint32_t> steps(plan.blocks.size(), 0);
    parallel_for(threads, plan.blocks.size(), 1, [&](std::size_t begin, std::size_t) {
      steps[begin] = smooth(plan.blocks[begin], step_);
      if (steps[begin] > 0) found = true;
    });
    if (!steps.empty()) step_ += *std::max_element(steps.begin(), steps.end());
    for (const std::vector<std::uint32_t>& set : plan.sets) {
      // No two have a patch in common, so one step will do for all.
      parallel_for(threads, set.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        PathMover mover(patched_, sizes_, max_triangles_);
        bool is_due = false;
        for (std::size_t i = begin; i < end; ++i) is_due |= look_at(mover, set[i], step_ + 1);
        if (is_due) found = true;
      });
      ++step_;
    }
    return found;
  }

 private:
  // Goes round until nothing is due; returns the number of steps, one for each that was.
  std::uint32_t smooth(const std::vector<std::uint32_t>& stretches, std::uint32_t step) {
    PathMover mover(patched_, sizes_, max_triangles_);
    std::uint32_t steps = 0;
    for (bool again = true; again && steps < kMaxSteps;) {
      again = false;
      for (const std::uint32_t s : stretches)
        if (look_at(mover, s, step + steps + 1)) {
          ++steps;
          again = true;
        }
    }
    return steps;
  }

  // Shortens a stretch if it may be, because one of its patches has changed since the last time.
  bool look_at(PathMover& mover, std::uint32_t s, std::uint32_t step) {
    const Stretch& stretch = patched_.borders.stretches[s];
    if (!is_blocked_[s] ||
        std::max(changed_at_[stretch.a], changed_at_[stretch.b]) <= checked_at_[s])
      return false;
    checked_at_[s] = step;
    if (mover.shorten(s)) changed_at_[stretch.a] = changed_at_[stretch.b] = step;
    is_blocked_[s] = mover.is_blocked();
    return true;
  }

  PatchedSurface& patched_;
  std::uint32_t max_triangles_;
  std::uint32_t step_ = 1;
  std::vector<std::uint32_t> sizes_;       // triangles per patch
  std::vector<std::uint32_t> checked_at_;  // the step that a stretch was looked at last
  std::vector<std::uint8_t> is_blocked_;   // whether a stretch waits for a change of its patches
  std::vector<std::uint32_t> changed_at_;  // the step that a patch changed last
};

double path_length(const SurfaceView& surface, const std::vector<std::uint32_t>& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    sum += glm::distance(DVec3(surface.positions[path[i - 1]]), DVec3(surface.positions[path[i]]));
  return sum;
}

// Adds the edges and the length of all stretches, times `sign`.
void add_stretches(const SurfaceView& surface, const std::vector<Stretch>& stretches, int sign,
                   SmoothingReport& report) {
  for (const Stretch& stretch : stretches) {
    report.edges += sign * static_cast<std::int64_t>(stretch.path.size() - 1);
    report.length += sign * path_length(surface, stretch.path);
  }
}

}  // namespace

SmoothingReport smooth_borders(const SurfaceView& surface, const EdgeLinks& links,
                               const SmoothedPatches& patches, int threads) {
  BorderStretches borders = find_stretches(surface, links, patches.patch_of);
  PatchedSurface patched{surface, links, patches.patch_of, borders,
                         LargeVector<std::uint32_t>(surface.positions.size(), kNone)};
  const std::uint64_t n = std::max(surface.triangle_count(), 1u);
  const auto patches_per_block =
      static_cast<std::uint32_t>(std::max<std::uint64_t>(kBlockTriangles * patches.count / n, 1));
  const WorkPlan plan = plan_work(borders.stretches, patches.count, patches_per_block);

  SmoothingReport report;
  add_stretches(surface, borders.stretches, 1, report);
  Smoother smoother(patched, patches);
  while (report.rounds < kMaxRounds && smoother.run(plan, threads)) ++report.rounds;
  add_stretches(surface, borders.stretches, -1, report);
  return report;
}

}  // namespace varifold
