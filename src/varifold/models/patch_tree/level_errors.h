// How far each level of a patch tree is from the level before and from the original.
//
// Based on: [Birkholz2007] section 3 (mean squared distance of the children's vertices).
// Differs: each vertex that went is measured to the nearest place of the coarser surface around its
//   survivor; beside the mean, the greatest distance of any vertex of the original is kept.
#pragma once

#include <varifold/simplify/pose_deviation.h>
#include <varifold/simplify/star_triangles.h>
#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace varifold {

/// Distances of the levels, in the units of the surface. Every point of the original is carried by
/// a point of the level, in whose star its nearest place was found: at first itself. What is
/// measured is the distance to some place of the surface, so never less than that to the nearest.
class LevelErrors {
 public:
  /// With `shapes`, the points of the surface in all its shapes, distances hold in every blend of
  /// these (NearestInShapes).
  LevelErrors(const WorkingSurface& surface, int threads, const ShapeTable* shapes = nullptr);

  /// The surface has been halved: `went` are the points that collapsed, each with the point where
  /// it ended up; `live` are those that are left. O(points of the original).
  void measure(std::span<const std::pair<std::uint32_t, std::uint32_t>> went,
               std::span<const std::uint32_t> live);

  /// Of a point that went with the last level, or stayed: the squared distance from where it was to
  /// the surface.
  [[nodiscard]] float squared_step(std::uint32_t point) const { return squared_[point]; }
  /// Of a live point: how far the points that it carries are from the surface at most.
  [[nodiscard]] float greatest(std::uint32_t point) const { return greatest_[point]; }

 private:
  struct Scratch {
    std::vector<StarTriangle> star;
    std::vector<std::uint32_t> rim;  // m and n of each
    std::vector<NearestInShapes::Corners> corners;
  };
  void sort_by_carrier();
  void measure_carried(std::uint32_t point, Scratch& scratch);
  void measure_batch(std::span<const std::uint32_t> samples, const Scratch& scratch);
  void measure_in_shapes(std::uint32_t sample, NearestInShapes& nearest, Scratch& scratch);
  void find_star(std::uint32_t point, Scratch& scratch) const;
  void walk_on(std::uint32_t sample, std::uint32_t next);

  const WorkingSurface& surface_;
  const ShapeTable* shapes_;
  int threads_;
  std::vector<std::uint32_t> carrier_;  // per point of the original
  std::vector<float> squared_;          // ... its distance
  std::vector<float> greatest_;         // per live point
  // The samples of each point that carries others, in rows.
  std::vector<std::uint32_t> first_, samples_;
};

}  // namespace varifold
