// Morphs by their rule: every vertex of a model moved in every frame.
#pragma once

#include <varifold/models/vdpm/instance.h>
#include <varifold/models/vdpm/odometers.h>
#include <varifold/models/vdpm/step_regions.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace varifold::test {

/// Per vertex the step that adds it; kNone for those of the base.
[[nodiscard]] inline std::vector<std::uint32_t> steps_of_vertices(const ViewDependentMesh& model) {
  std::vector<std::uint32_t> step_of(model.vertex_count(model.finest_level()), kNone);
  for (std::uint32_t step = 0; step < model.step_count(); ++step)
    for (std::uint32_t v = model.vertex_count(step); v < model.vertex_count(step + 1); ++v)
      step_of[v] = step;
  return step_of;
}

/// Where every vertex of the model is drawn, from the fronts of an instance without morphs.
class Simulation {
 public:
  Simulation(const ViewDependentInstance& still, std::uint32_t frames)
      : still_(still),
        frames_(frames),
        step_of_(steps_of_vertices(still.model())),
        count_(step_of_.size()),
        at_(count_),
        phase_(count_),
        left_(count_) {
    for (std::uint32_t v = 0; v < still.model().vertex_count(0); ++v) {
      phase_[v] = static_cast<int>(frames);
      at_[v] = looks_of(v);
    }
  }
  [[nodiscard]] bool is_drawn(std::uint32_t vertex) const { return phase_[vertex] > 0; }
  [[nodiscard]] const Vec3& at(std::uint32_t vertex) const { return at_[vertex]; }
  /// How far a vertex may have moved in the last frame.
  [[nodiscard]] float reach(std::uint32_t vertex) const { return reach_[vertex]; }
  /// Some morph turned round in the last frame.
  [[nodiscard]] int turns() const { return turns_; }

  /// `seen` by what the criteria of the frame ask; says what the next frame may do at once.
  void next(const RefineCriteria& criteria) {
    const auto frames = static_cast<int>(frames_);
    const std::vector<Vec3> before = at_;
    reach_.assign(count_, 0);
    find_touched();
    std::vector<int> begun = phase_;  // with what each vertex begins the frame
    for (std::uint32_t v = 0; v < count_; ++v) {
      const std::uint32_t target = still_.model().levels().target(v);
      const bool stays = step_of_[v] == kNone || still_.is_split(step_of_[v]);
      if (!stays && phase_[v] == 0) {
        at_[v] = at_[target];
        continue;
      }
      const float carried = target == kNone ? 0 : glm::length(at_[target] - before[target]);
      if (stays != stayed(v) && phase_[v] > 0 && phase_[v] < frames) ++turns_;
      if (stays) {
        const Vec3 goal = looks_of(v);
        const bool appears = phase_[v] == 0;
        if (appears) at_[v] = at_[target];
        if (!stayed(v)) {
          if (!was_seen(step_of_[v]))
            begun[v] = std::max(begun[v], first_phase(step_of_[v], begun));
          phase_[v] = begun[v];
          left_[v] = std::max(1, frames - phase_[v]);
        }
        if (touched_[v] == Touched::kSeen) left_[v] = frames;
        if (touched_[v] == Touched::kUnseen) left_[v] = std::max(1, left_[v]);
        reach_[v] = glm::length(goal - at_[v]) / static_cast<float>(std::max(1, left_[v]));
        if (appears) reach_[v] += carried;
        if (left_[v] > 0) at_[v] += (goal - at_[v]) / static_cast<float>(left_[v]--);
        phase_[v] = std::min(phase_[v] + 1, frames);
        goes_[v] = false;
      } else {
        reach_[v] = glm::length(at_[target] - at_[v]) / static_cast<float>(phase_[v]) + carried;
        at_[v] += (at_[target] - at_[v]) / static_cast<float>(phase_[v]--);
        goes_[v] = true;
      }
    }
    is_first_ = false;
    last_view_.reset();
    Odometers any(still_.model().bounding_ball());
    if (criteria.view) last_view_.emplace(*criteria.view, 1.0f, any.reach(criteria.view->eye, 1));
  }

 private:
  enum class Touched : std::uint8_t { kNot, kUnseen, kSeen };

  [[nodiscard]] bool was_seen(std::uint32_t step) const {
    const ViewDependentMesh& model = still_.model();
    if (is_first_) return false;
    return !last_view_ || last_view_->may_see(own_region(model.bounds(step), model.center(step)));
  }
  // As far as what the step requires is.
  [[nodiscard]] int first_phase(std::uint32_t step, const std::vector<int>& begun) const {
    auto phase = static_cast<int>(frames_);
    still_.model().for_each_required(step, [&](std::uint32_t required) {
      phase = std::min(phase, begun[still_.model().first_vertex(required)]);
    });
    return phase;
  }
  [[nodiscard]] bool stayed(std::uint32_t v) const { return phase_[v] > 0 && !goes_[v]; }
  // Those that the placement of a step moves that has changed since the frame before.
  void find_touched() {
    const ViewDependentMeshData& data = still_.model().data();
    touched_.assign(count_, Touched::kNot);
    for (std::uint32_t step = 0; step < still_.model().step_count(); ++step) {
      if (was_split_[step] == still_.is_split(step)) continue;
      was_split_[step] = still_.is_split(step);
      if (!still_.model().moves_vertices()) continue;
      const Touched how = was_seen(step) ? Touched::kSeen : Touched::kUnseen;
      for (std::uint32_t j = data.first_placed[step]; j < data.first_placed[step + 1]; ++j)
        touched_[data.placed_vertex[j]] = std::max(touched_[data.placed_vertex[j]], how);
    }
  }
  [[nodiscard]] Vec3 looks_of(std::uint32_t v) const {
    const ActiveVertices& vertices = still_.surface().vertices();
    return vertices.buffer().positions[vertices.slot(v)];
  }

  const ViewDependentInstance& still_;
  std::uint32_t frames_;
  std::vector<std::uint32_t> step_of_;
  std::size_t count_;
  std::vector<Vec3> at_;
  std::vector<int> phase_, left_;
  std::vector<bool> goes_ = std::vector<bool>(count_, false);
  std::vector<Touched> touched_;
  std::optional<ViewQuery> last_view_;
  bool is_first_ = true;
  std::vector<bool> was_split_ = std::vector<bool>(still_.model().step_count(), false);
  std::vector<float> reach_;
  int turns_ = 0;
};

}  // namespace varifold::test
