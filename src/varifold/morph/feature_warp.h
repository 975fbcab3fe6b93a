// Small moves of a map onto the sphere that never fold it.
#pragma once

#include <varifold/base/math.h>
#include <varifold/morph/sphere_point.h>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace varifold {

/// A map that is changed in place; a triangulation of the whole sphere, all triangles positive.
/// `is_fixed` is null, or says of a disc which vertices must stay: those of its boundary, on the
/// equator, and the one below.
struct MutableSphereMap {
  std::span<const std::uint32_t> indices;
  std::span<const Vec3> positions;
  std::span<SpherePoint> points;
  const std::vector<bool>* is_fixed = nullptr;

  [[nodiscard]] bool may_move(std::uint32_t vertex) const {
    return is_fixed == nullptr || !(*is_fixed)[vertex];
  }
};

struct Pin {
  std::uint32_t vertex = 0;
  SpherePoint goal;
};

struct WarpReport {
  double farthest = 0;  ///< of a pin from its goal at the end, in radians; 0: all are there
  std::uint32_t rounds = 0;
};

/// Brings vertices to their goals: the whole sphere flows with them in small steps, which are
/// refused where they fold, and all others are relaxed in between. Every triangle stays positive.
/// Ends when all are there, or when none has come nearer in many rounds: pins may bar each other's
/// way. At most 300 rounds of O(n pins).
[[nodiscard]] WarpReport drag_to_goals(const MutableSphereMap& map, std::span<const Pin> pins);

/// Moves every vertex by up to `reach` radians to a random side, less where its star demands
/// it. Every triangle stays positive. O(n); the same for the same seed.
void jitter(const MutableSphereMap& map, double reach, std::uint64_t seed);

}  // namespace varifold
