// Where the vertices of patches stand while they blend between levels: the rule that the vertex
// shader follows, and the same for the processor.
//
// Based on: [Hoppe1996] section 4.1 (geomorphs).
// Differs: a vertex blends by its own projected error and not by time, so that what is drawn is a
//   function of the view alone, and so that patches with a common border agree without knowing of
//   each other (docs/algorithms/patch_drawing.md).
#pragma once

#include <varifold/view/camera.h>
#include <varifold/view/patch_draws.h>
#include <algorithm>
#include <cmath>

namespace varifold {

/// When vertices blend: those whose error covers `tolerance` stand at their target, those of
/// `band` times that at their own place, and between the two in between.
struct PatchMorphRange {
  Vec3 eye{0};              ///< in the model's own coordinates
  float near_distance = 0;  ///< where everything is that is nearer
  /// A length covers this, divided by the distance: PixelScale::focal_pixels(), or 1 where the
  /// errors are roots of mean squares.
  float scale = 1;
  /// The priority, in that unit, at which the front ends: the tolerance in pixels, or that of the
  /// node where a budget stopped. Positive.
  float tolerance = 1;
  /// Above 1. Up to 2, no vertex is farther from its own place than the tolerance, as far as its
  /// way is no longer than its error. The more levels blend at once, the more triangles are turned
  /// over on their way: a few in a picture with 1.25 (docs/algorithms/patch_drawing.md).
  float band = 1.25f;
};

[[nodiscard]] inline PatchMorphRange pixel_morph_range(const PixelScale& scale, float tolerance) {
  return {scale.eye(), scale.near_distance(), scale.focal_pixels(), tolerance};
}

/// For errors that are roots of mean squares, and priorities that are mean squares by the squared
/// distance.
[[nodiscard]] inline PatchMorphRange mean_squared_morph_range(const Vec3& eye, float tolerance) {
  return {eye, 0, 1, std::sqrt(tolerance)};
}

/// 1: at the target; 0: at its own place. O(1).
[[nodiscard]] inline float morph_part(const PatchMorphRange& range, const Vec3& position,
                                      float error) {
  const float least = std::max(range.near_distance, 1e-30f);
  const float distance = std::max(glm::length(position - range.eye), least);
  const float seen = error * range.scale / distance;
  const float part = (range.band * range.tolerance - seen) / ((range.band - 1) * range.tolerance);
  return std::min(std::max(part, 0.0f), 1.0f);
}

/// Where a vertex is drawn: at its own place, on the way to its target, or, where that is on its
/// way as well, to where that is. O(levels), mostly one or two steps.
[[nodiscard]] inline Vec3 morphed_position(const PatchDrawList& list, std::uint32_t vertex,
                                           const PatchMorphRange& range) {
  const Vec3 own = list.positions[vertex];
  Vec3 position = own, way(0);
  float weight = 1;
  while (true) {
    const PatchMorph& morph = list.morphs[vertex];
    if (morph.target == vertex) break;
    weight *= morph_part(range, position, morph.error);
    if (weight <= 0) break;
    vertex = morph.target;
    way += weight * (list.positions[vertex] - position);
    position = list.positions[vertex];
  }
  return own + way;
}

}  // namespace varifold
