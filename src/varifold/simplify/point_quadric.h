// The quadric of the faces that a point has now.
//
// Based on: [GarlandHeckbert1997] sections 5 and 6.2, [Hoppe1999] section 4 (memoryless).
// Differs: no memory at all: summed from the ring whenever it is needed, so it costs no storage and
//   no updates. Against gathered quadrics the error falls by a quarter (docs/performance.md).
#pragma once

#include <varifold/simplify/attribute_field.h>
#include <varifold/simplify/pose_places.h>
#include <varifold/simplify/quadric.h>
#include <varifold/simplify/working_surface.h>

namespace varifold {

struct QuadricOptions {
  float border_weight = 2.0f;  ///< of the planes that hold borders and non-manifold edges
  float seam_weight = 1.0f;    ///< of the planes that hold seams and material borders
  /// Weight of the squared distance along the surface: breaks ties on flat regions in favour of
  /// short moves, far below the weight of the distance from the surface.
  float tangential_weight = 1e-6f;
};

struct PointQuadric {
  Quadric quadric;   ///< about the point
  float weight = 0;  ///< a third of the area of its faces
};

/// The neighbours of a point relative to it, in ring order, axis by axis in blocks of eight that
/// compilers turn into vector instructions. Reuses its memory; not to be copied while in use.
class RingOffsets {
 public:
  static constexpr std::size_t kBlock = 8;

  void gather(const WorkingSurface& surface, std::uint32_t point);
  void gather(const WorkingSurface& surface, std::uint32_t point, const PosePlaces& pose);
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] Vec3 operator[](std::size_t i) const { return {x_[i], y_[i], z_[i]}; }

  /// The quadric of the faces, without constraints.
  [[nodiscard]] PointQuadric face_quadric() const;
  /// The quadric's error at every neighbour; valid until the next call.
  [[nodiscard]] const float* errors(const Quadric& quadric);

 private:
  template <class Places>
  void gather_places(const WorkingSurface& surface, std::uint32_t point, const Places& places);

  static constexpr std::size_t kInline = 32;
  // One more than a block holds: the successor of the last.
  static constexpr std::size_t padded(std::size_t size) {
    return (size + kBlock - 1) / kBlock * kBlock + kBlock;
  }

  float inline_[5 * (kInline + kBlock)];
  std::vector<float> long_;
  float* x_ = inline_;
  float* y_ = nullptr;
  float* z_ = nullptr;
  float* is_face_ = nullptr;  // 1, or 0 at a gap
  float* errors_ = nullptr;
  std::size_t size_ = 0;
};

/// Face quadric, constraints and tie-break from gathered offsets.
[[nodiscard]] PointQuadric point_quadric(WorkingSurface& surface, std::uint32_t point,
                                         const QuadricOptions& options, const RingOffsets& offsets);

/// The same in another pose.
[[nodiscard]] PointQuadric point_quadric(WorkingSurface& surface, std::uint32_t point,
                                         const QuadricOptions& options, const RingOffsets& offsets,
                                         const PosePlaces& pose);

/// O(ring); O(ring^2) at feature points.
[[nodiscard]] PointQuadric point_quadric(WorkingSurface& surface, std::uint32_t point,
                                         const QuadricOptions& options);

/// Enters all faces into the attribute quadrics of their corners. O(n).
void add_faces_to_attributes(WorkingSurface& surface, AttributeField& attributes, int threads);

}  // namespace varifold
