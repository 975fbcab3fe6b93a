// Where the points of a surface are in its other poses, and what a collapse does there.
//
// Based on: [Ramos2008] section 6.3.2.
// Differs: not an order for each frame but one for all: costs are the mean of the quadrics of all
//   poses, each about its own faces ([MohrGleicher2003] sums gathered quadrics so), and a collapse
//   must be legal in every pose.
#pragma once

#include <varifold/base/large_vector.h>
#include <varifold/simplify/legality.h>
#include <varifold/simplify/point_quadric.h>
#include <varifold/simplify/pose_places.h>
#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Errors of the collapses of a point onto each of its neighbours.
struct RingErrors {
  const float* errors = nullptr;  ///< in ring order
  float weight = 0;               ///< PointQuadric::weight
};

/// Memory that poses use again and again; one for each thread.
struct PoseScratch {
  RingOffsets offsets;
  std::vector<float> errors;
};

/// The other poses of a surface.
class PoseField {
 public:
  /// None.
  PoseField() = default;
  /// Each shape, that at rest and the poses, has a place for every vertex of the mesh that the
  /// surface was made of; normals are those of the faces around each point. O(points * poses).
  PoseField(const WorkingSurface& surface, std::span<const Vec3> rest,
            std::span<const std::span<const Vec3>> poses, int threads);

  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] std::uint32_t pose_count() const { return count_; }
  [[nodiscard]] PosePlaces pose(std::uint32_t number) const {
    return {places_.data() + number, count_};
  }
  [[nodiscard]] std::size_t bytes() const {
    return (places_.size() + exact_.size()) * sizeof(PosePlace);
  }

  /// The mean over all poses, that at rest among them; valid until the scratch is used again.
  /// O(ring * poses).
  [[nodiscard]] RingErrors mean_errors(WorkingSurface& surface, std::uint32_t point,
                                       const QuadricOptions& options, const RingErrors& at_rest,
                                       PoseScratch& scratch) const;

  /// The part of test_collapse() that is about the shape of faces, in these poses, and at rest once
  /// more: with places that were not rounded. What is large in one shape of a morph may be as small
  /// as rounding in another, where it could be turned over unnoticed. O(ring * poses).
  [[nodiscard]] Refusal test(WorkingSurface& surface, std::uint32_t from, std::uint32_t onto,
                             const LegalityOptions& options) const;

 private:
  // What moves places near 0, and to about one unit.
  struct Placement {
    DVec3 center;
    double scale;
  };
  // Where the places of one shape are written.
  struct Column {
    PosePlace* first;
    std::size_t stride;
  };
  static void fill(const WorkingSurface& surface, std::span<const Vec3> shape,
                   const Placement& placement, const Column& column, int threads);

  LargeVector<PosePlace> places_;
  LargeVector<PosePlace> exact_;  // of all shapes, that at rest first; nothing was rounded
  std::uint32_t count_ = 0;
};

}  // namespace varifold
