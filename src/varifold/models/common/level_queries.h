// The part of UniformModel that a level table answers.
#pragma once

#include <varifold/models/common/level_table.h>
#include <cstdint>

namespace varifold {

/// For a model that has `const LevelTable& levels() const`; see LevelTable for what each gives.
template <class Model>
class LevelQueries {
 public:
  [[nodiscard]] std::uint32_t finest_level() const { return table().finest_level(); }
  [[nodiscard]] std::uint32_t vertex_count(std::uint32_t level) const {
    return table().vertex_count(level);
  }
  [[nodiscard]] std::uint32_t triangle_count(std::uint32_t level) const {
    return table().triangle_count(level);
  }
  /// A distance in model units; see CollapseSequence::error for what it bounds.
  [[nodiscard]] float error(std::uint32_t level) const { return table().error(level); }
  [[nodiscard]] bool error_is_measured() const { return table().error_is_measured(); }
  [[nodiscard]] std::uint32_t level_for_triangles(std::uint32_t count) const {
    return table().level_for_triangles(count);
  }
  [[nodiscard]] std::uint32_t level_for_vertices(std::uint32_t count) const {
    return table().level_for_vertices(count);
  }
  [[nodiscard]] std::uint32_t level_for_error(float bound) const {
    return table().level_for_error(bound);
  }
  [[nodiscard]] std::uint32_t level_for_fraction(float fraction) const {
    return table().level_for_fraction(fraction);
  }
  [[nodiscard]] std::uint32_t ancestor(std::uint32_t vertex, std::uint32_t level) const {
    return table().ancestor(vertex, level);
  }

 private:
  [[nodiscard]] const LevelTable& table() const {
    return static_cast<const Model&>(*this).levels();
  }
};

}  // namespace varifold
