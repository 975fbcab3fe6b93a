#include <varifold/models/strips/dependencies.h>

#include <varifold/models/common/dependency_walk.h>
#include <varifold/models/strips/strip_framework.h>
#include <algorithm>

namespace varifold {

namespace {

constexpr std::uint32_t kLastDependency = StripFrameworkData::kLastDependency;

// Per step, the first of the vertices that go to its own; and the next one for each of those.
struct ComingVertices {
  explicit ComingVertices(const LevelTable& levels) {
    step_of.assign(levels.vertex_count(0), kNone);
    for (std::uint32_t k = 0; k < levels.finest_level(); ++k)
      step_of.insert(step_of.end(), levels.step(k).vertices, k);
    first.assign(levels.finest_level(), kNone);
    next.assign(step_of.size(), kNone);
    for (std::uint32_t v = levels.vertex_count(0); v < step_of.size(); ++v) {
      const std::uint32_t to = step_of[levels.target(v)];
      if (to == kNone) continue;
      next[v] = first[to];
      first[to] = v;
    }
  }
  std::vector<std::uint32_t> step_of, first, next;
};

}  // namespace

const char* DependencyLists::read(std::span<const std::uint32_t> words, std::uint32_t steps) {
  begin_.resize(steps);
  count_.assign(steps, 0);
  std::size_t at = 0;
  for (std::uint32_t k = steps; k-- > 0;) {
    begin_[k] = static_cast<std::uint32_t>(steps_.size());
    for (bool last = false; !last; ++at) {
      if (at == words.size()) return "a step has no dependencies";
      last = (words[at] & kLastDependency) != 0;
      if (words[at] == kNone && count_[k] == 0) continue;
      const std::uint32_t finer = words[at] & ~kLastDependency;
      if (finer <= (count_[k] == 0 ? k : steps_.back()) || finer >= steps)
        return "a step depends on one that is not finer, or out of order";
      steps_.push_back(finer);
      ++count_[k];
    }
  }
  return at == words.size() ? nullptr : "there are more dependencies than steps";
}

std::vector<std::uint32_t> packed_dependencies(const StepGraph& graph) {
  std::vector<std::uint32_t> packed;
  packed.reserve(graph.edge_count() + graph.step_count() / 8);
  for (std::uint32_t k = graph.step_count(); k-- > 0;) {
    const auto steps = graph.of(k);
    packed.insert(packed.end(), steps.begin(), steps.end());
    if (steps.empty())
      packed.push_back(kNone);
    else
      packed.back() |= kLastDependency;
  }
  packed.shrink_to_fit();
  return packed;
}

const char* dependency_fault(std::span<const std::uint32_t> words, const LevelTable& levels) {
  const std::uint32_t steps = levels.finest_level();
  DependencyLists lists;
  if (const char* fault = lists.read(words, steps)) return fault;
  const ComingVertices coming(levels);
  DependencyWalk walk(steps);
  for (std::uint32_t k = 0; k < steps; ++k) walk.set(k, lists.of(k));
  for (std::uint32_t k = 0; k < steps; ++k) {
    if (coming.first[k] == kNone) continue;
    // Lists go from newer to older vertices, so the first one is of the finest step.
    const std::uint32_t last = coming.step_of[coming.first[k]];
    const auto own = lists.of(k);
    walk.begin(k);
    for (const std::uint32_t finer : own)
      if (!walk.is_marked(finer)) walk.follow(finer, last);
    for (std::uint32_t v = coming.first[k]; v != kNone; v = coming.next[v]) {
      const std::uint32_t step = coming.step_of[v];
      if (!walk.is_marked(step) && !std::binary_search(own.begin(), own.end(), step))
        return "a step does not depend on all that go to its vertices";
    }
  }
  return nullptr;
}

}  // namespace varifold
