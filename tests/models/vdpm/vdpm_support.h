// View-dependent meshes of all test meshes, and their fronts by definition.
#pragma once

#include <tests/models/level_checks.h>
#include <tests/support/meshes.h>

#include <varifold/base/random.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/models/vdpm/instance.h>
#include <varifold/simplify/simplify.h>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace varifold::test {

struct NamedVdpm {
  std::string name;
  DetailedMesh detailed;
  std::shared_ptr<const ViewDependentMesh> model;
};

/// Every test mesh, and some that are hard to take apart, with kept and with optimal placement;
/// made once.
[[nodiscard]] const std::vector<NamedVdpm>& all_vdpms();
[[nodiscard]] NamedVdpm make_vdpm(const NamedMesh& named, Placement placement);

/// The mesh where all steps but those of `split` are collapsed, by its definition: every vertex
/// goes from target to target until it comes to one that is there. O(mesh).
[[nodiscard]] TriangleMesh mesh_of_steps(const DetailedMesh& detailed,
                                         const std::vector<bool>& split);

/// A camera near a mesh with this ball, somewhere in front of it.
[[nodiscard]] RefineCriteria random_view(const Sphere& ball, Random& random);
/// On an orbit at three radii; the angle in radians.
[[nodiscard]] RefineCriteria orbit_view(const Sphere& ball, float angle);

/// Does single steps that the rule allows, in any order, on a surface and in a list of what is
/// split. Knows the rule from the requirements alone.
class RandomWalk {
 public:
  RandomWalk(const ViewDependentMesh& model, std::uint64_t seed);
  /// Tries some steps, one after the other; `upwards`: how likely it is that a split is done where
  /// one is possible, collapses are done with the opposite probability.
  void walk(ActiveSurface& surface, std::uint32_t tries, double upwards);
  [[nodiscard]] const std::vector<bool>& split() const { return split_; }

 private:
  [[nodiscard]] bool may_change(std::uint32_t step) const;

  std::uint32_t steps_;
  Random random_;
  std::vector<bool> split_;
  std::vector<std::vector<std::uint32_t>> required_, required_by_;
};

}  // namespace varifold::test
