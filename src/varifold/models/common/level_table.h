// What all uniform models know of their levels: counts, errors, and where vertices go.
#pragma once

#include <varifold/simplify/collapse_sequence.h>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Levels run from 0, the base, to finest_level(), full detail, as in CollapseSequence. About a
/// third of a byte a level for counts, hardly anything for errors, and 4 bytes a vertex for the
/// history. Immutable.
class LevelTable {
 public:
  LevelTable() = default;
  /// O(steps). Errors are rounded up to two bytes (error_code.h).
  explicit LevelTable(const CollapseSequence& sequence);

  [[nodiscard]] std::uint32_t finest_level() const { return finest_level_; }
  /// O(1).
  [[nodiscard]] std::uint32_t vertex_count(std::uint32_t level) const;
  [[nodiscard]] std::uint32_t triangle_count(std::uint32_t level) const;
  /// A distance in model units; see CollapseSequence::error for what it bounds. O(log levels).
  [[nodiscard]] float error(std::uint32_t level) const;
  [[nodiscard]] bool error_is_measured() const { return error_is_measured_; }

  /// The finest level with at most so many triangles or vertices; 0 where even the base has more.
  [[nodiscard]] std::uint32_t level_for_triangles(std::uint32_t count) const;
  [[nodiscard]] std::uint32_t level_for_vertices(std::uint32_t count) const;
  /// The coarsest level whose error is at most `bound`.
  [[nodiscard]] std::uint32_t level_for_error(float bound) const;
  /// 1 is full detail, 0 the base; the vertex count is linear in between.
  [[nodiscard]] std::uint32_t level_for_fraction(float fraction) const;

  /// Per vertex, where it goes when it vanishes: target(v) < v; kNone for vertices of the base.
  [[nodiscard]] std::uint32_t target(std::uint32_t vertex) const { return target_[vertex]; }
  [[nodiscard]] std::span<const std::uint32_t> targets() const { return target_; }
  /// The vertex that stands for `vertex` at `level`. O(depth).
  [[nodiscard]] std::uint32_t ancestor(std::uint32_t vertex, std::uint32_t level) const;

  /// How many vertices (wedges of one point) and triangles the split from `level` adds. O(1).
  struct Step {
    std::uint32_t vertices = 0;
    std::uint32_t triangles = 0;
  };
  [[nodiscard]] Step step(std::uint32_t level) const {
    const Group& group = groups_[level / kGroup];
    const std::uint64_t bit = std::uint64_t{1} << (level % kGroup);
    if ((group.irregular & bit) == 0) return kRegular;
    return exceptions_[group.first_exception +
                       static_cast<std::uint32_t>(std::popcount(group.irregular & (bit - 1)))];
  }

  [[nodiscard]] std::size_t bytes() const;

 private:
  friend class LevelTableCoder;  // level_table_bytes.cpp
  static constexpr std::uint32_t kGroup = 64;
  static constexpr Step kRegular{1, 2};
  // So many levels, and the counts at the first of them.
  struct Group {
    std::uint64_t irregular = 0;  // a bit per step
    Step counts;
    std::uint32_t first_exception = 0;
  };
  struct ErrorRun {
    std::uint32_t first_level, code;
  };
  [[nodiscard]] Step counts(std::uint32_t level) const;
  void push_step(Step step);

  std::uint32_t finest_level_ = 0;
  Step end_;                      // counts at the finest level
  std::vector<Group> groups_{1};  // that of the finest level too
  std::vector<Step> exceptions_;  // the steps that are not regular
  std::vector<ErrorRun> errors_;  // falling codes, each from a level on
  std::vector<std::uint32_t> target_;
  bool error_is_measured_ = false;
};

}  // namespace varifold
