// Collapses that move the vertex that stays to the place of least error.
//
// Based on: [GarlandHeckbert1997] section 4, [Hoppe1999] section 4 (memoryless quadrics).
// Differs: quadrics sit at the vertices in single precision; one candidate a vertex in the bucket
//   queue. Preserving the volume [LindstromTurk1998] was tried and changed nothing.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/simplify/collapse_rounds.h>
#include <varifold/simplify/point_quadric.h>
#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// Where the steps of a log move the vertices that stay.
struct PlacementLog {
  std::vector<std::uint32_t> first;  ///< per step: range in the arrays below; one more at the end
  std::vector<std::uint32_t> wedge;  ///< which wedge; points where there are no wedge tables
  TriangleMesh attributes;           ///< one vertex an entry, in model units
};

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
