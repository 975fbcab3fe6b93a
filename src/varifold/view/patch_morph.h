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
#include <cmath>

namespace varifold {

/// When vertices blend: those whose error covers `tolerance` stand at their target, those of
/// `band` times that at their own place, and between the two in between.
struct PatchMorphRange {
  Vec3 eye{0};
  float near_distance = 0;  ///< where everything is that is nearer
  /// A length covers this, divided by the distance: PixelScale::focal_pixels(), or 1 where the
  /// errors are roots of mean squares.
  float scale = 1;
  /// The priority, in that unit, at which the front ends: the tolerance in pixels, or that of the
  /// node where a budget stopped.
  float tolerance = 1;
  /// Above 1. With 2 no vertex is farther from its own place than the tolerance, as far as its way
  /// is no longer than its error.
  float band = 2;
};

[[nodiscard]] inline PatchMorphRange pixel_morph_range(const PixelScale& scale, float tolerance) {
  return {scale.eye(), scale.near_distance(), scale.focal_pixels(), tolerance, 2};
}

/// 1: at the target; 0: at its own place. O(1).
[[nodiscard]] inline float morph_part(const PatchMorphRange& range, const Vec3& position,
                                      float error) {
  const float distance = std::max(glm::length(position - range.eye), range.near_distance);
  const float seen = error * range.scale / distance;
  const float part = (range.band * range.tolerance - seen) / ((range.band - 1) * range.tolerance);
  return std::min(std::max(part, 0.0f), 1.0f);
}

/// Where a vertex is drawn: at its own place, on the way to its target, or, where that is on its
/// way as well, ... O(levels), mostly one or two steps.
[[nodiscard]] inline Vec3 morphed_position(const PatchDrawList& list, std::uint32_t vertex,
                                           const PatchMorphRange& range) {
  Vec3 sum(0);
  float weight = 1;
  while (true) {
    const Vec3 own = list.positions[vertex];
    const PatchMorph& morph = list.morphs[vertex];
    const float part = morph.target == vertex ? 0 : morph_part(range, own, morph.error);
    sum += weight * (1 - part) * own;
    weight *= part;
    if (weight <= 0) return sum;
    vertex = morph.target;
  }
}

}  // namespace varifold
