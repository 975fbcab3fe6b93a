#include <varifold/models/common/level_table.h>

#include <varifold/models/common/error_code.h>
#include <varifold/models/common/level_search.h>
#include <algorithm>
#include <cmath>

namespace varifold {

LevelTable::LevelTable(const CollapseSequence& sequence)
    : target_(sequence.target), error_is_measured_(sequence.error_is_measured) {
  const std::uint32_t steps = sequence.step_count();
  if (!sequence.vertices.empty()) base_ = {sequence.vertices[0], sequence.triangles[0]};
  steps_.reserve(steps);
  for (std::uint32_t k = 0; k < steps; ++k)
    push_step({sequence.vertices[k + 1] - sequence.vertices[k],
               sequence.triangles[k + 1] - sequence.triangles[k]});
  // Rounded up to their stored form, and never rising with the level.
  std::vector<ErrorRun> backwards;
  std::uint32_t greatest = 0;
  for (auto level = static_cast<std::uint32_t>(sequence.error.size()); level-- > 0;) {
    greatest = std::max(greatest, error_code(sequence.error[level]));
    if (!backwards.empty() && backwards.back().code == greatest)
      backwards.back().first_level = level;
    else
      backwards.push_back({level, greatest});
  }
  errors_.assign(backwards.rbegin(), backwards.rend());
  finish();
}

void LevelTable::push_step(Step step) {
  const bool fits = step.vertices < 16 && step.triangles < 15;
  if (!fits) exceptions_.push_back({finest_level(), step.vertices, step.triangles});
  steps_.push_back(fits ? static_cast<std::uint8_t>(step.vertices | step.triangles << 4u)
                        : kException);
}

void LevelTable::finish() {
  steps_.shrink_to_fit();
  checkpoints_.reserve(steps_.size() / kCheckpoint + 1);
  Step counts = base_;
  for (std::uint32_t k = 0; k <= finest_level(); ++k) {
    if (k % kCheckpoint == 0) checkpoints_.push_back(counts);
    if (k == finest_level()) break;
    const Step added = step(k);
    counts.vertices += added.vertices;
    counts.triangles += added.triangles;
  }
}

LevelTable::Step LevelTable::exception(std::uint32_t level) const {
  const auto found =
      std::lower_bound(exceptions_.begin(), exceptions_.end(), level,
                       [](const Exception& e, std::uint32_t l) { return e.level < l; });
  return {found->vertices, found->triangles};
}

LevelTable::Step LevelTable::counts(std::uint32_t level) const {
  if (checkpoints_.empty()) return {};
  Step counts = checkpoints_[level / kCheckpoint];
  for (std::uint32_t k = level - level % kCheckpoint; k < level; ++k) {
    const Step added = step(k);
    counts.vertices += added.vertices;
    counts.triangles += added.triangles;
  }
  return counts;
}

std::uint32_t LevelTable::vertex_count(std::uint32_t level) const { return counts(level).vertices; }

std::uint32_t LevelTable::triangle_count(std::uint32_t level) const {
  return counts(level).triangles;
}

float LevelTable::error(std::uint32_t level) const {
  const auto after =
      std::upper_bound(errors_.begin(), errors_.end(), level,
                       [](std::uint32_t l, const ErrorRun& run) { return l < run.first_level; });
  return after == errors_.begin() ? 0.0f : error_of_code((after - 1)->code);
}

std::uint32_t LevelTable::level_for_triangles(std::uint32_t count) const {
  return last_level(finest_level(), [&](std::uint32_t k) { return triangle_count(k) <= count; });
}

std::uint32_t LevelTable::level_for_vertices(std::uint32_t count) const {
  return last_level(finest_level(), [&](std::uint32_t k) { return vertex_count(k) <= count; });
}

std::uint32_t LevelTable::level_for_error(float bound) const {
  const auto first = std::partition_point(errors_.begin(), errors_.end(), [&](const ErrorRun& run) {
    return error_of_code(run.code) > bound;
  });
  return first == errors_.end() ? finest_level() : first->first_level;
}

std::uint32_t LevelTable::level_for_fraction(float fraction) const {
  const double base = base_.vertices;
  const auto all = static_cast<double>(target_.size());
  const double clamped = std::clamp(static_cast<double>(fraction), 0.0, 1.0);
  return level_for_vertices(static_cast<std::uint32_t>(std::floor(base + clamped * (all - base))));
}

std::uint32_t LevelTable::ancestor(std::uint32_t vertex, std::uint32_t level) const {
  const std::uint32_t live = vertex_count(level);
  while (vertex >= live) vertex = target_[vertex];
  return vertex;
}

std::size_t LevelTable::bytes() const {
  return steps_.size() + exceptions_.size() * sizeof(Exception) +
         checkpoints_.size() * sizeof(Step) + errors_.size() * sizeof(ErrorRun) +
         target_.size() * sizeof(std::uint32_t);
}

}  // namespace varifold
