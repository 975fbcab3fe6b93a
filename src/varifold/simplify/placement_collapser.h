// Collapses that move the vertex that stays to the place of least error.
//
// Based on: [GarlandHeckbert1997] section 4, [Hoppe1999] section 4 (memoryless quadrics).
// Differs: quadrics sit at the vertices in single precision; one candidate a vertex in the bucket
//   queue. Preserving the volume [LindstromTurk1998] was tried and changed nothing.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/simplify/collapse_rounds.h>
#include <varifold/simplify/placement_recorder.h>
#include <varifold/simplify/point_quadric.h>
#include <varifold/simplify/working_surface.h>
#include <cstdint>

namespace varifold {

struct PlacementOptions {
  LegalityOptions legality;
  std::uint32_t target_faces = 0;
  QuadricOptions quadric;
  Progress progress;
};

/// What is collapsed, and the attributes that go along.
struct PlacementInput {
  WorkingSurface& surface;
  const TriangleMesh& mesh;    ///< that the surface was built from
  AttributeField* attributes;  ///< their part of the cost; null: geometry alone decides
};

/// Collapses one edge after the other until nothing legal is left or the target is reached; one
/// thread. Positions of the surface and quadrics of the attributes change.
[[nodiscard]] CollapseLog collapse_with_placement(const PlacementInput& input,
                                                  const PlacementOptions& options,
                                                  PlacementLog& placement);

}  // namespace varifold
