// Meshes that move: any mesh with random poses, joints and animations.
#pragma once

#include <varifold/mesh/rig.h>
#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>

namespace varifold::test {

struct RigOptions {
  std::uint32_t poses = 3;   ///< every second one has normals where the mesh has them
  std::uint32_t joints = 5;  ///< 0: no skin
  std::uint32_t animations = 2;
};

/// The mesh with seeded random poses, a skin, and animations of all kinds of channels and
/// interpolations. Vertices at one place have the same poses and joints.
[[nodiscard]] TriangleMesh with_random_rig(TriangleMesh mesh, std::uint64_t seed,
                                           const RigOptions& options = {});

}  // namespace varifold::test
