// What all uniform models know of their levels: counts, errors, and where vertices go.
#pragma once

#include <varifold/simplify/collapse_sequence.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Levels run from 0, the base, to finest_level(), full detail, as in CollapseSequence. About
/// 1.2 bytes a level for counts and errors, and 4 bytes a vertex for the history. Immutable.
class LevelTable {
 public:
  LevelTable() = default;
  /// O(steps). Errors are rounded up to two bytes (error_code.h).
  explicit LevelTable(const CollapseSequence& sequence);

  [[nodiscard]] std::uint32_t finest_level() const {
    return static_cast<std::uint32_t>(steps_.size());
  }
  /// O(1): at most kCheckpoint bytes are read.
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

  /// How many vertices (wedges of one point) and triangles the split from `level` adds. O(1) where
  /// they are 1 and 2, as nearly always, else O(log exceptions).
  struct Step {
    std::uint32_t vertices = 0;
    std::uint32_t triangles = 0;
  };
  [[nodiscard]] Step step(std::uint32_t level) const {
    const std::uint8_t code = steps_[level];
    return code != kException ? Step{code & 15u, std::uint32_t{code} >> 4u} : exception(level);
  }

  [[nodiscard]] std::size_t bytes() const;

 private:
  friend class LevelTableCoder;  // level_table_bytes.cpp
  static constexpr std::uint32_t kCheckpoint = 64;
  static constexpr std::uint8_t kException = 0xff;
  struct Exception {
    std::uint32_t level, vertices, triangles;
  };
  struct ErrorRun {
    std::uint32_t first_level, code;
  };
  [[nodiscard]] Step exception(std::uint32_t level) const;
  [[nodiscard]] Step counts(std::uint32_t level) const;
  void push_step(Step step);
  void finish();

  Step base_;
  std::vector<std::uint8_t> steps_;  // vertices in the low, triangles in the high half
  std::vector<Exception> exceptions_;
  std::vector<Step> checkpoints_;
  std::vector<ErrorRun> errors_;  // falling codes, each from a level on
  std::vector<std::uint32_t> target_;
  bool error_is_measured_ = false;
};

}  // namespace varifold
