#include <varifold/models/common/step_graph.h>

#include <varifold/base/parallel.h>
#include <varifold/models/common/dependency_walk.h>
#include <varifold/simplify/sequence_replay.h>
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace varifold {

namespace {

// The vertices that the collapse of a step moves and that stay.
std::span<const std::uint32_t> moved_vertices(const CollapseSequence& sequence,
                                              std::uint32_t step) {
  if (!sequence.moves_vertices()) return {};
  const std::uint32_t first = sequence.first_placed[step];
  return {sequence.placed_vertex.data() + first, sequence.first_placed[step + 1] - first};
}

// Walks from the finest step down and finds all that each depends on.
class CandidateWalk {
 public:
  CandidateWalk(const DetailedMesh& detailed, const SequenceHistory& history)
      : sequence_(detailed.sequence),
        history_(history),
        steps_(sequence_.step_count()),
        base_vertices_(steps_ == 0 ? 0 : sequence_.vertices[0]),
        last_change_(detailed.mesh.triangle_count(), kNone) {
    if (steps_ == 0) return;
    if (sequence_.moves_vertices()) replay_.emplace(detailed);
    if (sequence_.vertices[steps_] != base_vertices_ + steps_)
      step_of_ = steps_of_vertices(sequence_);
    waiting_.assign(steps_ + (replay_ ? base_vertices_ : 0), {});
  }

  // Appends those of the next step, in any order, some of them more than once.
  void next(std::uint32_t step, std::vector<std::uint32_t>& candidates) {
    prefetch(step);
    // The steps that removed triangles around what this one removes or moves, ...
    take_waiting(step, candidates);
    for (const std::uint32_t v : moved_vertices(sequence_, step))
      take_waiting(point_of(v), candidates);
    // ... and those that made the triangles of its star what they are now.
    if (replay_) change_around_moved(step, candidates);
    for (std::uint32_t v = sequence_.vertices[step]; v < sequence_.vertices[step + 1]; ++v) {
      for (const std::uint32_t slot : history_.changed(v)) change(slot / 3, step, candidates);
      wait(sequence_.target[v], step);
    }
    for (const std::uint32_t triangle : history_.added(step)) {
      change(triangle, step, candidates);
      for (std::uint32_t corner = 0; corner < 3; ++corner)
        wait(history_.first_corners()[3 * std::size_t{triangle} + corner], step);
    }
    // What moves a vertex comes after all that moved it before.
    for (const std::uint32_t v : moved_vertices(sequence_, step)) wait(v, step);
  }

 private:
  // The steps that wait for the next collapse of a point, the last one here; `next` tells where
  // among `waited_` the one before it is.
  struct Waiting {
    std::uint32_t step = kNone, next = kNone;
  };

  // What is known of steps and triangles lies all over memory; what a later step needs is fetched
  // early.
  void prefetch(std::uint32_t step) const {
    constexpr std::uint32_t kAhead = 16;
    if (step < kAhead) return;
    const std::uint32_t later = step - kAhead;
    if (waiting_[later].next != kNone) __builtin_prefetch(&waited_[waiting_[later].next]);
    for (const std::uint32_t slot : history_.changed(sequence_.vertices[later]))
      __builtin_prefetch(&last_change_[slot / 3]);
  }

  // Notes that a step changes a triangle of its star.
  void change(std::uint32_t triangle, std::uint32_t step, std::vector<std::uint32_t>& candidates) {
    std::uint32_t& last = last_change_[triangle];
    if (last != kNone && last != step) candidates.push_back(last);
    last = step;
  }

  void change_around_moved(std::uint32_t step, std::vector<std::uint32_t>& candidates) {
    slots_.clear();
    for (const std::uint32_t v : moved_vertices(sequence_, step)) replay_->slots_of(v, slots_);
    for (const std::uint32_t slot : slots_) change(slot / 3, step, candidates);
    replay_->collapse();
  }

  // A point is the step that removes it, or, where vertices of the base move, the number of steps
  // and the number of the vertex.
  [[nodiscard]] std::uint32_t point_of(std::uint32_t vertex) const {
    if (vertex < base_vertices_) return replay_ ? steps_ + vertex : kNone;
    return step_of_.empty() ? vertex - base_vertices_ : step_of_[vertex];
  }

  // Who asks will be asked itself by whoever comes to the point next, so that its list can go.
  void take_waiting(std::uint32_t point, std::vector<std::uint32_t>& candidates) {
    for (Waiting at = std::exchange(waiting_[point], {}); at.step != kNone;
         at = at.next == kNone ? Waiting() : waited_[at.next])
      candidates.push_back(at.step);
  }

  // The next collapse that removes or moves that vertex will have to wait for `step`.
  void wait(std::uint32_t vertex, std::uint32_t step) {
    const std::uint32_t point = point_of(vertex);
    if (point == kNone || point == step) return;
    Waiting& last = waiting_[point];
    if (last.step == step) return;
    std::uint32_t next = kNone;
    if (last.step != kNone) {
      next = static_cast<std::uint32_t>(waited_.size());
      waited_.push_back(last);
    }
    last = {step, next};
  }

  const CollapseSequence& sequence_;
  const SequenceHistory& history_;
  std::uint32_t steps_, base_vertices_;
  std::vector<std::uint32_t> last_change_;  // per triangle
  std::optional<SequenceReplay> replay_;    // where vertices move
  std::vector<std::uint32_t> step_of_;      // where steps have several vertices
  std::vector<Waiting> waiting_;            // per point
  std::vector<Waiting> waited_;
  std::vector<std::uint32_t> slots_;
};

// Leaves out candidates that a candidate nearer to the step depends on.
class Reducer {
 public:
  explicit Reducer(std::uint32_t steps) : walk_(steps) {}

  // Appends the others to `edges`, ascending.
  void reduce(std::uint32_t step, std::span<std::uint32_t> candidates,
              std::vector<std::uint32_t>& edges) {
    std::sort(candidates.begin(), candidates.end());
    candidates = candidates.first(static_cast<std::size_t>(
        std::unique(candidates.begin(), candidates.end()) - candidates.begin()));
    const std::size_t begin = edges.size();
    walk_.begin(step);
    for (const std::uint32_t candidate : candidates) walk_.want(candidate);
    for (const std::uint32_t candidate : candidates) {
      if (walk_.is_marked(candidate)) continue;
      edges.push_back(candidate);
      walk_.give_up_one();
      if (!walk_.wants_more()) break;
      walk_.follow(candidate, candidates.back());
      if (!walk_.wants_more()) break;
    }
    walk_.set(step, std::span(edges).subspan(begin));
  }

 private:
  DependencyWalk walk_;
};

// The candidates of a run of steps, the finest first.
struct CandidateBlock {
  std::uint32_t begin = 0, end = 0;
  std::vector<std::uint32_t> candidates, ends;
};

}  // namespace

std::vector<std::uint32_t> steps_of_vertices(const CollapseSequence& sequence) {
  std::vector<std::uint32_t> steps(sequence.target.size(), kNone);
  for (std::uint32_t k = 0; k < sequence.step_count(); ++k)
    for (std::uint32_t v = sequence.vertices[k]; v < sequence.vertices[k + 1]; ++v) steps[v] = k;
  return steps;
}

StepGraph::StepGraph(const DetailedMesh& detailed, const SequenceHistory& history, int threads) {
  // Blocks are found while those before them are reduced.
  constexpr std::uint32_t kBlock = 8192;
  const std::uint32_t steps = detailed.sequence.step_count();
  begin_.assign(std::size_t{steps} + 1, 0);
  edges_.reserve(2 * std::size_t{steps});
  CandidateWalk walk(detailed, history);
  Reducer reducer(steps);
  const auto find = [&](CandidateBlock& block) {
    block.candidates.clear();
    block.ends.clear();
    for (std::uint32_t k = block.end; k-- > block.begin;) {
      walk.next(k, block.candidates);
      block.ends.push_back(static_cast<std::uint32_t>(block.candidates.size()));
    }
  };
  const auto reduce = [&](CandidateBlock& block) {
    std::uint32_t first = 0, k = block.end;
    for (const std::uint32_t end : block.ends) {
      reducer.reduce(--k, std::span(block.candidates).subspan(first, end - first), edges_);
      begin_[k] = static_cast<std::uint32_t>(edges_.size());
      first = end;
    }
  };
  std::array<CandidateBlock, 2> blocks;
  for (std::uint32_t end = steps, turn = 0; end > 0 || !blocks[turn ^ 1u].ends.empty(); turn ^= 1) {
    CandidateBlock &found = blocks[turn], &before = blocks[turn ^ 1u];
    found.end = end;
    end = found.begin = end - std::min(end, kBlock);
    parallel_for(threads, 2, 1, [&](std::size_t piece, std::size_t) {
      if (piece == 0)
        find(found);
      else
        reduce(before);
    });
    before.ends.clear();
  }
}

}  // namespace varifold
