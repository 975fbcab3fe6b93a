#include <varifold/models/common/level_table.h>

#include <varifold/models/common/error_code.h>
#include <varifold/models/common/level_search.h>
#include <algorithm>
#include <cmath>

namespace varifold {

LevelTable::LevelTable(const CollapseSequence& sequence)
    : target_(sequence.target), error_is_measured_(sequence.error_is_measured) {
  const std::uint32_t steps = sequence.step_count();
  if (!sequence.vertices.empty()) end_ = {sequence.vertices[0], sequence.triangles[0]};
  groups_[0].counts = end_;
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
}

void LevelTable::push_step(Step step) {
  if (step.vertices != kRegular.vertices || step.triangles != kRegular.triangles) {
    groups_.back().irregular |= std::uint64_t{1} << (finest_level_ % kGroup);
    exceptions_.push_back(step);
  }
  end_.vertices += step.vertices;
  end_.triangles += step.triangles;
  if (++finest_level_ % kGroup == 0)
    groups_.push_back({0, end_, static_cast<std::uint32_t>(exceptions_.size())});
}

LevelTable::Step LevelTable::counts(std::uint32_t level) const {
  const Group& group = groups_[level / kGroup];
  const std::uint64_t before = (std::uint64_t{1} << (level % kGroup)) - 1;
  const auto irregular = static_cast<std::uint32_t>(std::popcount(group.irregular & before));
  const std::uint32_t regular = level % kGroup - irregular;
  Step counts{group.counts.vertices + regular * kRegular.vertices,
              group.counts.triangles + regular * kRegular.triangles};
  for (std::uint32_t i = 0; i < irregular; ++i) {
    counts.vertices += exceptions_[group.first_exception + i].vertices;
    counts.triangles += exceptions_[group.first_exception + i].triangles;
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
  const double base = groups_[0].counts.vertices;
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
  return groups_.size() * sizeof(Group) + exceptions_.size() * sizeof(Step) +
         errors_.size() * sizeof(ErrorRun) + target_.size() * sizeof(std::uint32_t);
}

}  // namespace varifold
