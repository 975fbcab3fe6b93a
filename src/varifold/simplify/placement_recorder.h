// Notes where collapses move the vertices that stay, with the attributes that they get there.
#pragma once

#include <varifold/simplify/ring_merge.h>
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

/// How far along the edge from `start` to `end` the place lies, in [0, 1]: so far do attributes go.
[[nodiscard]] float edge_parameter(const Vec3& start, const Vec3& end, const Vec3& place);

class PlacementRecorder {
 public:
  /// `mesh` is what the surface was built from.
  PlacementRecorder(const WorkingSurface& surface, const TriangleMesh& mesh, PlacementLog& log);

  /// The next collapse moves `onto` to `place` (unit scale). Attributes are interpolated `t` of the
  /// way along the edge, wedge by wedge as match_wedges() has paired them in `scratch`.
  void record(std::uint32_t onto, const Vec3& place, float t, const MergeScratch& scratch);

 private:
  void blend(std::uint32_t from, std::uint32_t onto, float t);
  void push(std::uint32_t wedge, const Vec3& position);

  const WorkingSurface& surface_;
  PlacementLog& log_;
  TriangleMesh attributes_;  // per wedge, as they are now; without wedge tables there are none
};

}  // namespace varifold
