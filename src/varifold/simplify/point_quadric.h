// The quadric of the faces that a point has now.
//
// Based on: [GarlandHeckbert1997] sections 5 and 6.2, [Hoppe1999] section 4 (memoryless).
// Differs: no memory at all: summed from the ring whenever it is needed, so it costs no storage and
//   no updates. Against gathered quadrics the error falls by a quarter (docs/performance.md).
#pragma once

#include <varifold/simplify/attribute_field.h>
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

/// O(ring); O(ring^2) at feature points.
[[nodiscard]] PointQuadric point_quadric(WorkingSurface& surface, std::uint32_t point,
                                         const QuadricOptions& options);

/// Enters all faces into the attribute quadrics of their corners. O(n).
void add_faces_to_attributes(WorkingSurface& surface, AttributeField& attributes);

}  // namespace varifold
