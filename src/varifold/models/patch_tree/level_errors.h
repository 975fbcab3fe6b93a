// How far each level of a patch tree is from the level before and from the original.
//
// Based on: [Birkholz2007] section 3 (mean squared distance of the children's vertices).
// Differs: each vertex that went is measured to the nearest place of the coarser surface around its
//   survivor; beside the mean, the greatest distance of samples of the original is kept.
#pragma once

#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace varifold {

/// Distances of the levels, in the units of the surface. A point of the surface carries the sample
/// of the original that was farthest from the surface around it.
class LevelErrors {
 public:
  explicit LevelErrors(const WorkingSurface& surface, int threads);

  /// The surface has been halved: `went` are the points that collapsed, each with the point where
  /// it ended up; `live` are those that are left. O(points).
  void measure(std::span<const std::pair<std::uint32_t, std::uint32_t>> went,
               std::span<const std::uint32_t> live);

  /// Of a point that went with the last level, or stayed: the squared distance from where it was to
  /// the surface.
  [[nodiscard]] float squared_step(std::uint32_t point) const { return step_[point]; }
  /// Of a live point: how far the samples that it stands for are from the surface.
  [[nodiscard]] float greatest(std::uint32_t point) const { return greatest_[point]; }

 private:
  [[nodiscard]] float squared_distance(std::uint32_t sample, std::uint32_t point) const;
  void carry(std::uint32_t point, std::uint32_t sample, float squared);

  const WorkingSurface& surface_;
  int threads_;
  std::vector<float> step_;  // squared
  std::vector<float> greatest_;
  std::vector<std::uint32_t> sample_;  // a point of the original
};

}  // namespace varifold
