#include <varifold/models/common/step_graph.h>

#include <varifold/simplify/sequence_replay.h>
#include <algorithm>

namespace varifold {

namespace {

// The vertices that the collapse of a step moves and that stay.
std::span<const std::uint32_t> moved_vertices(const CollapseSequence& sequence,
                                              std::uint32_t step) {
  if (!sequence.moves_vertices()) return {};
  const std::uint32_t first = sequence.first_placed[step];
  return {sequence.placed_vertex.data() + first, sequence.first_placed[step + 1] - first};
}

}  // namespace

std::vector<std::uint32_t> steps_of_vertices(const CollapseSequence& sequence) {
  std::vector<std::uint32_t> steps(sequence.target.size(), kNone);
  for (std::uint32_t k = 0; k < sequence.step_count(); ++k)
    for (std::uint32_t v = sequence.vertices[k]; v < sequence.vertices[k + 1]; ++v) steps[v] = k;
  return steps;
}

StepGraph::StepGraph(const DetailedMesh& detailed)
    : base_waits_(detailed.sequence.moves_vertices()),
      step_of_(steps_of_vertices(detailed.sequence)) {
  const CollapseSequence& sequence = detailed.sequence;
  const std::uint32_t steps = sequence.step_count();
  begin_.assign(steps, 0);
  end_.assign(steps, 0);
  first_waiting_.assign(steps + (base_waits_ ? sequence.vertices[0] : 0), kNone);
  last_change_.assign(detailed.mesh.triangle_count(), kNone);
  DependencyWalk walk(steps);
  SequenceReplay replay(detailed);
  for (std::uint32_t k = steps; k-- > 0;) {
    find_candidates(sequence, replay, k);
    reduce(k, walk);
    replay.collapse();
    enter(sequence, replay, k);
  }
  waiting_ = {};
  first_waiting_ = step_of_ = last_change_ = slots_ = candidates_ = {};
}

// What the collapse of `step` depends on, and in `slots_` the triangles around the vertices that
// it moves.
void StepGraph::find_candidates(const CollapseSequence& sequence, const SequenceReplay& replay,
                                std::uint32_t step) {
  // The steps that made the triangles of the star what they are now, ...
  slots_.clear();
  candidates_.clear();
  for (std::uint32_t v = sequence.vertices[step]; v < sequence.vertices[step + 1]; ++v)
    replay.slots_of(v, slots_);
  for (const std::uint32_t v : moved_vertices(sequence, step)) replay.slots_of(v, slots_);
  for (const std::uint32_t slot : slots_)
    if (last_change_[slot / 3] != kNone) candidates_.push_back(last_change_[slot / 3]);
  // ... and those that removed others around it.
  take_waiting(step);
  for (const std::uint32_t v : moved_vertices(sequence, step)) take_waiting(point_of(v));
}

// Notes what the collapse of `step`, just done, changed.
void StepGraph::enter(const CollapseSequence& sequence, const SequenceReplay& replay,
                      std::uint32_t step) {
  for (const std::uint32_t slot : replay.changed()) last_change_[slot / 3] = step;
  const auto moved = moved_vertices(sequence, step);
  if (!moved.empty())
    for (const std::uint32_t slot : slots_) last_change_[slot / 3] = step;
  for (const std::uint32_t triangle : replay.removed())
    for (std::uint32_t corner = 0; corner < 3; ++corner)
      wait(replay.corners()[3 * std::size_t{triangle} + corner], step);
  for (std::uint32_t v = sequence.vertices[step]; v < sequence.vertices[step + 1]; ++v)
    wait(sequence.target[v], step);
  // What moves a vertex comes after all that moved it before.
  for (const std::uint32_t v : moved) wait(v, step);
}

std::uint32_t StepGraph::point_of(std::uint32_t vertex) const {
  if (step_of_[vertex] != kNone) return step_of_[vertex];
  return base_waits_ ? step_count() + vertex : kNone;
}

// Who asks will be asked itself by whoever comes to the point next, so that its list can go.
void StepGraph::take_waiting(std::uint32_t point) {
  for (std::uint32_t i = first_waiting_[point]; i != kNone; i = waiting_[i].next)
    candidates_.push_back(waiting_[i].step);
  first_waiting_[point] = kNone;
}

// The next collapse that removes or moves that vertex will have to wait for `step`.
void StepGraph::wait(std::uint32_t vertex, std::uint32_t step) {
  const std::uint32_t waits = point_of(vertex);
  if (waits == kNone || waits == step) return;
  std::uint32_t& first = first_waiting_[waits];
  if (first != kNone && waiting_[first].step == step) return;
  waiting_.push_back({step, first});
  first = static_cast<std::uint32_t>(waiting_.size() - 1);
}

// Enters the candidates but those that a candidate nearer to the step depends on.
void StepGraph::reduce(std::uint32_t step, DependencyWalk& walk) {
  std::sort(candidates_.begin(), candidates_.end());
  candidates_.erase(std::unique(candidates_.begin(), candidates_.end()), candidates_.end());
  begin_[step] = static_cast<std::uint32_t>(edges_.size());
  walk.begin(step);
  for (const std::uint32_t candidate : candidates_) {
    if (walk.is_marked(candidate)) continue;
    edges_.push_back(candidate);
    walk.follow(candidate, candidates_.back(), [&](std::uint32_t s) { return of(s); });
  }
  end_[step] = static_cast<std::uint32_t>(edges_.size());
}

}  // namespace varifold
