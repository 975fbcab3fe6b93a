// Sequences of all test meshes, and brute-force answers about their steps.
#pragma once

#include <tests/support/meshes.h>
#include <varifold/models/vdpm/step_bounds.h>
#include <varifold/simplify/simplify.h>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace varifold::test {

/// Radians.
[[nodiscard]] inline double angle_between(const Vec3& a, const Vec3& b) {
  const DVec3 p(a), q(b);
  return std::atan2(glm::length(glm::cross(p, q)), glm::dot(p, q));
}
/// Of the axis to the rim, radians.
[[nodiscard]] inline double angle_of(const NormalCone& cone) {
  return std::atan2(double{cone.sine}, cone.cosine);
}

struct NamedSequence {
  std::string name;
  DetailedMesh detailed;
};

/// All groups, a planet and a terrain, as far as they have at most so many steps.
[[nodiscard]] std::vector<NamedSequence> sequences(Placement placement, std::uint32_t most_steps);

/// Of the steps that a step requires the finest; kNone for those that require none.
[[nodiscard]] std::vector<std::uint32_t> finest_required(const DetailedMesh& detailed);
/// A random smaller step, or kNone, per step.
[[nodiscard]] std::vector<std::uint32_t> random_parents(std::uint32_t steps, std::uint64_t seed);

[[nodiscard]] std::vector<StepBounds> bounds_of(const DetailedMesh& detailed,
                                                const StepBoundsOptions& options = {});

/// The corners of the triangles around the point that step k removes and around the vertices that
/// it moves: at level k + 1, and at level k those that are left of them.
struct Star {
  Vec3 center;
  std::vector<std::array<Vec3, 3>> before, after;
};
/// By the definition of levels. O(mesh) each.
class Stars {
 public:
  explicit Stars(const DetailedMesh& detailed);
  [[nodiscard]] Star of(std::uint32_t step) const;

 private:
  const DetailedMesh& detailed_;
  std::vector<std::vector<Vec3>> positions_;  // per level where vertices move, else once
};

/// The full mesh with the given steps collapsed: every corner its first ancestor that is left, and
/// no triangle that one of these steps removes. Kept vertices only.
[[nodiscard]] TriangleMesh surface_without(const DetailedMesh& detailed,
                                           const std::vector<bool>& is_collapsed);
/// Random steps, with all that each depends on: most of those in one half of the mesh, few in the
/// other.
[[nodiscard]] std::vector<bool> random_front(const DetailedMesh& detailed, std::uint64_t seed);

/// Of every sample, which steps move it and how far it is off then, the finest step first; the last
/// of them may come to a triangle that is so great that the sample is let go.
struct Move {
  std::uint32_t step;
  Vec3 residual;
  bool is_ear, is_last;
};
struct SampleHistory {
  std::vector<Vec3> positions;
  std::vector<std::vector<Move>> moves;
};
[[nodiscard]] SampleHistory history_of_samples(const DetailedMesh& detailed,
                                               const StepBoundsOptions& options = {});

}  // namespace varifold::test
