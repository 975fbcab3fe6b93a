#include <varifold/models/vdpm/assemble.h>

#include <algorithm>

namespace varifold {

namespace {

// Lists of steps, one for each step, in one row.
class StepLists {
 public:
  // pairs(f) calls f(list, step) for all entries, those of each list in ascending order, and the
  // same ones whenever it is called.
  template <class Pairs>
  StepLists(std::uint32_t lists, const Pairs& pairs) : begin_(lists + 1, 0) {
    pairs([&](std::uint32_t list, std::uint32_t) { ++begin_[list + 1]; });
    for (std::uint32_t i = 0; i < lists; ++i) begin_[i + 1] += begin_[i];
    steps_.resize(begin_[lists]);
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    pairs([&](std::uint32_t list, std::uint32_t step) { steps_[next[list]++] = step; });
  }
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t list) const {
    return {steps_.data() + begin_[list], begin_[list + 1] - begin_[list]};
  }

 private:
  std::vector<std::uint32_t> begin_, steps_;
};

// A step's change, as the triangles are at the finer of its two levels; slots ascending.
void set_change(const CollapseSequence& sequence, const SequenceHistory& history,
                std::uint32_t step, StepChange& change) {
  const std::vector<std::uint32_t>& corners = history.first_corners();
  change.changed.clear();
  change.added.clear();
  for (std::uint32_t v = sequence.vertices[step]; v < sequence.vertices[step + 1]; ++v) {
    const std::size_t first = change.changed.size();
    for (const std::uint32_t slot : history.changed(v))
      change.changed.push_back({slot / 3, slot % 3, v});
    std::sort(change.changed.begin() + static_cast<std::ptrdiff_t>(first), change.changed.end(),
              [](const StepChange::Corner& a, const StepChange::Corner& b) {
                return a.triangle != b.triangle ? a.triangle < b.triangle : a.corner < b.corner;
              });
  }
  for (const std::uint32_t t : history.added(step))
    change.added.push_back({t,
                            {corners[3 * std::size_t{t}], corners[3 * std::size_t{t} + 1],
                             corners[3 * std::size_t{t} + 2]}});
}

void link_placements(const CollapseSequence& sequence, ViewDependentMeshData& data) {
  if (!sequence.moves_vertices()) return;
  data.first_placed = sequence.first_placed;
  data.placed_vertex = sequence.placed_vertex;
  data.placed = sequence.placed;
  data.finer.assign(data.placed_vertex.size(), kNone);
  // Walks down: a vertex looks as the last step that moved it made it. What removes it comes after
  // all of these.
  data.first_look.assign(sequence.target.size(), kNone);
  for (std::uint32_t k = sequence.step_count(); k-- > 0;) {
    for (std::uint32_t j = data.first_placed[k]; j < data.first_placed[k + 1]; ++j) {
      std::uint32_t& look = data.first_look[data.placed_vertex[j]];
      data.finer[j] = look;
      look = j;
    }
  }
}

void assemble_base(const CollapseSequence& sequence, const std::vector<std::uint32_t>& corners,
                   ViewDependentMeshData& data) {
  for (std::uint32_t t = 0; t < sequence.triangle_level.size(); ++t) {
    if (sequence.triangle_level[t] > 0) continue;
    data.base_triangles.push_back(t);
    for (std::uint32_t c = 0; c < 3; ++c)
      data.base_corners.push_back(corners[3 * std::size_t{t} + c]);
  }
}

}  // namespace

std::vector<std::uint32_t> watch_parents(const StepGraph& graph) {
  // The lists are walked from the coarsest step up, so that the last entry is the finest.
  std::vector<std::uint32_t> parents(graph.step_count(), kNone);
  for (std::uint32_t k = 0; k < graph.step_count(); ++k)
    for (const std::uint32_t finer : graph.of(k)) parents[finer] = k;
  return parents;
}

ViewDependentMeshData assemble_steps(const DetailedMesh& detailed, const SequenceHistory& history,
                                     const StepGraph& graph,
                                     std::span<const std::uint32_t> watch_parent) {
  const CollapseSequence& sequence = detailed.sequence;
  const std::uint32_t steps = sequence.step_count();
  ViewDependentMeshData data;
  link_placements(sequence, data);
  const StepLists required(steps, [&](const auto& enter) {
    for (std::uint32_t k = 0; k < steps; ++k)
      for (const std::uint32_t finer : graph.of(k)) enter(finer, k);
  });
  const StepLists watched(steps, [&](const auto& enter) {
    for (std::uint32_t k = 0; k < steps; ++k)
      if (watch_parent[k] != kNone) enter(watch_parent[k], k);
  });
  for (std::uint32_t k = 0; k < steps; ++k)
    if (watch_parent[k] == kNone) data.watch_roots.push_back(k);

  assemble_base(sequence, history.first_corners(), data);
  data.records.begin(detailed.mesh.vertex_count(),
                     static_cast<std::uint32_t>(sequence.triangle_level.size()), steps,
                     detailed.mesh.ranges.size() < 2);
  StepChange change;
  for (std::uint32_t k = 0; k < steps; ++k) {
    set_change(sequence, history, k, change);
    change.required.assign(required.of(k).begin(), required.of(k).end());
    change.watched.assign(watched.of(k).begin(), watched.of(k).end());
    const std::uint32_t vertex = sequence.vertices[k];
    const bool single = sequence.vertices[k + 1] == vertex + 1;
    data.records.append(change, single ? vertex : kNone, single ? sequence.target[vertex] : kNone);
  }
  data.records.finish();
  return data;
}

}  // namespace varifold
