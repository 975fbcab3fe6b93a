#include <varifold/models/strips/verify_dependencies.h>

#include <varifold/models/strips/dependencies.h>
#include <varifold/models/strips/strip_levels.h>
#include <varifold/simplify/collapse_sequence.h>
#include <algorithm>
#include <span>

namespace varifold {

namespace {

// As much of the mesh that the model was built from as a replay needs: triangles may come in
// another order.
DetailedMesh replayable(const StripFramework& model) {
  const LevelTable& levels = model.levels();
  const TriangleStrips strips = model.full_strips();
  const std::vector<std::uint32_t> level_of =
      strip_levels(model.attributes(), levels, strips).level_of;
  DetailedMesh detailed;
  detailed.mesh.positions = model.attributes().positions;
  CollapseSequence& sequence = detailed.sequence;
  sequence.target.assign(levels.targets().begin(), levels.targets().end());
  for (std::uint32_t s = 0; s < strips.count(); ++s) {
    const auto strip = strips.strip(s);
    for (std::uint32_t i = 0; i + 2 < strip.size(); ++i) {
      const std::uint32_t level = level_of[strips.first[s] + i];
      if (level == kNone) continue;
      const auto corners = strip_triangle(strip, i);
      detailed.mesh.indices.insert(detailed.mesh.indices.end(), corners.begin(), corners.end());
      sequence.triangle_level.push_back(level);
    }
  }
  for (std::uint32_t k = 0; k <= levels.finest_level(); ++k) {
    sequence.vertices.push_back(levels.vertex_count(k));
    sequence.triangles.push_back(levels.triangle_count(k));
  }
  return detailed;
}

// Looks along dependencies without end, but no further than the one that is looked for.
class Reach {
 public:
  Reach(const DependencyLists& lists, std::uint32_t steps) : lists_(lists), mark_(steps, kNone) {}

  [[nodiscard]] bool leads_to(std::uint32_t step, std::uint32_t finer) {
    ++search_;
    stack_.assign(1, step);
    while (!stack_.empty()) {
      const std::uint32_t at = stack_.back();
      stack_.pop_back();
      for (const std::uint32_t next : lists_.of(at)) {
        if (next == finer) return true;
        if (next > finer) break;
        if (mark_[next] == search_) continue;
        mark_[next] = search_;
        stack_.push_back(next);
      }
    }
    return false;
  }

 private:
  const DependencyLists& lists_;
  std::vector<std::uint32_t> mark_, stack_;
  std::uint32_t search_ = 0;
};

}  // namespace

std::vector<std::uint32_t> steps_lacking_dependencies(const StripFramework& model) {
  const std::uint32_t steps = model.finest_level();
  DependencyLists lists;
  std::vector<std::uint32_t> lacking;
  if (lists.read(model.data().dependencies, steps) != nullptr) return lacking;
  const StepGraph needed(replayable(model));
  Reach reach(lists, steps);
  for (std::uint32_t k = 0; k < steps && lacking.size() < kMostStepsLacking; ++k) {
    const auto own = lists.of(k);
    const auto is_met = [&](std::uint32_t finer) {
      return std::binary_search(own.begin(), own.end(), finer) || reach.leads_to(k, finer);
    };
    const auto all = needed.of(k);
    if (!std::all_of(all.begin(), all.end(), is_met)) lacking.push_back(k);
  }
  return lacking;
}

}  // namespace varifold
