#include <varifold/models/strips/build_graph.h>

#include <varifold/models/strips/strip_framework.h>
#include <varifold/simplify/sequence_replay.h>
#include <algorithm>

namespace varifold {

std::vector<std::uint32_t> steps_of_vertices(const CollapseSequence& sequence) {
  std::vector<std::uint32_t> steps(sequence.target.size(), kNone);
  for (std::uint32_t k = 0; k < sequence.step_count(); ++k)
    for (std::uint32_t v = sequence.vertices[k]; v < sequence.vertices[k + 1]; ++v) steps[v] = k;
  return steps;
}

StepGraph::StepGraph(const DetailedMesh& detailed)
    : step_of_(steps_of_vertices(detailed.sequence)) {
  const CollapseSequence& sequence = detailed.sequence;
  const std::uint32_t steps = sequence.step_count();
  begin_.assign(steps, 0);
  end_.assign(steps, 0);
  first_waiting_.assign(steps, kNone);
  DependencyWalk walk(steps);

  SequenceReplay replay(detailed);
  std::vector<std::uint32_t> last_change(detailed.mesh.triangle_count(), kNone);
  std::vector<std::uint32_t> slots, candidates;
  for (std::uint32_t k = steps; k-- > 0;) {
    // The steps that made the triangles around the point what they are now, ...
    slots.clear();
    for (std::uint32_t v = sequence.vertices[k]; v < sequence.vertices[k + 1]; ++v)
      replay.slots_of(v, slots);
    candidates.clear();
    for (const std::uint32_t slot : slots)
      if (last_change[slot / 3] != kNone) candidates.push_back(last_change[slot / 3]);
    // ... and those that removed others around it.
    for (std::uint32_t i = first_waiting_[k]; i != kNone; i = waiting_[i].next)
      candidates.push_back(waiting_[i].step);
    reduce(k, walk, candidates);

    replay.collapse();
    for (const std::uint32_t slot : replay.changed()) last_change[slot / 3] = k;
    for (const std::uint32_t triangle : replay.removed())
      for (std::uint32_t corner = 0; corner < 3; ++corner)
        wait(replay.corners()[3 * std::size_t{triangle} + corner], k);
    for (std::uint32_t v = sequence.vertices[k]; v < sequence.vertices[k + 1]; ++v)
      wait(sequence.target[v], k);
  }
  waiting_ = {};
  first_waiting_ = step_of_ = {};
}

// The collapse of that vertex will have to wait for `step`.
void StepGraph::wait(std::uint32_t vertex, std::uint32_t step) {
  const std::uint32_t waits = step_of_[vertex];
  if (waits == kNone || waits == step) return;
  std::uint32_t& first = first_waiting_[waits];
  if (first != kNone && waiting_[first].step == step) return;
  waiting_.push_back({step, first});
  first = static_cast<std::uint32_t>(waiting_.size() - 1);
}

// Enters the candidates but those that a candidate nearer to the step depends on.
void StepGraph::reduce(std::uint32_t step, DependencyWalk& walk,
                       std::vector<std::uint32_t>& candidates) {
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  begin_[step] = static_cast<std::uint32_t>(edges_.size());
  walk.begin(step);
  for (const std::uint32_t candidate : candidates) {
    if (walk.is_marked(candidate)) continue;
    edges_.push_back(candidate);
    walk.follow(candidate, candidates.back(), [&](std::uint32_t s) { return of(s); });
  }
  end_[step] = static_cast<std::uint32_t>(edges_.size());
}

std::vector<std::uint32_t> StepGraph::packed() const {
  std::vector<std::uint32_t> packed;
  packed.reserve(edges_.size() + begin_.size() / 8);
  for (auto k = static_cast<std::uint32_t>(begin_.size()); k-- > 0;) {
    const auto steps = of(k);
    packed.insert(packed.end(), steps.begin(), steps.end());
    if (steps.empty())
      packed.push_back(kNone);
    else
      packed.back() |= StripFrameworkData::kLastDependency;
  }
  packed.shrink_to_fit();
  return packed;
}

}  // namespace varifold
