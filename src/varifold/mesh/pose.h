// Poses and skins: what lets the vertices of one mesh take several places.
#pragma once

#include <varifold/base/math.h>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace varifold {

/// Another shape of a mesh: a place for each of its vertices, not an offset. Normals are empty or
/// one for each vertex and need not have unit length: blends are normalised, not what is blended.
struct Pose {
  std::string name;
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  friend bool operator==(const Pose&, const Pose&) = default;
};

/// The joints (Rig::joints) that a vertex follows, and how much. Weights are not negative and sum
/// up to 1; unused places are joint 0 with weight 0.
struct JointWeights {
  std::array<std::uint16_t, 4> joints{0, 0, 0, 0};
  std::array<float, 4> weights{0, 0, 0, 0};
  friend bool operator==(const JointWeights&, const JointWeights&) = default;
};

}  // namespace varifold
