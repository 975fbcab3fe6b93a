// The quadrics that every point starts with.
#pragma once

#include <varifold/simplify/attribute_field.h>
#include <varifold/simplify/working_surface.h>

namespace varifold {

struct ErrorOptions {
  float border_weight = 10.0f;  ///< of the planes that hold borders and non-manifold edges
  float seam_weight = 1.0f;     ///< of the planes that hold seams and material borders
  /// Weight of the squared distance along the surface: breaks ties on flat regions in favour of
  /// short moves, far below the weight of the distance from the surface.
  float tangential_weight = 1e-7f;
  int threads = 0;
};

/// Sets quadric and weight of every point: a third of each face's area on the plane of the face,
/// planes through feature edges at right angles to their faces, and the attributes' share. O(n).
void set_initial_error(WorkingSurface& surface, AttributeField* attributes,
                       const ErrorOptions& options);

}  // namespace varifold
