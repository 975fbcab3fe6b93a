// Shapes for meshes: what bends, twists and scatters them, seeded.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/simplify/collapse_sequence.h>
#include <cstdint>
#include <vector>

namespace varifold::test {

/// Another shape: bent, twisted and swollen smoothly, all wedges of a point alike. `strength` is a
/// part of the diagonal.
[[nodiscard]] Pose bent_pose(const TriangleMesh& mesh, std::uint64_t seed, float strength);
/// The mesh with `count` of them beside it.
[[nodiscard]] TriangleMesh with_poses(TriangleMesh mesh, std::uint32_t count, std::uint64_t seed,
                                      float strength = 0.2f);

/// Another shape that is turned by `angle` radians about a seeded axis, and whose surface has slid
/// along itself before: each axis is stretched here and pressed together there, so that flat faces
/// along the axes stay flat. No shape shows what is off in blends of the two.
[[nodiscard]] Pose turned_pose(const TriangleMesh& mesh, std::uint64_t seed, float angle);
/// The mesh with `count` of them beside it, each turned by `angle` about another axis.
[[nodiscard]] TriangleMesh with_turned_poses(TriangleMesh mesh, std::uint32_t count,
                                             std::uint64_t seed, float angle);

/// Weights >= 0 for `count` shapes that sum up to 1: one alone, two, or all, by the seed.
[[nodiscard]] std::vector<float> blend_weights(std::size_t count, std::uint64_t seed);

/// The mesh in one of its shapes alone: 0 is that at rest. Without poses, skin and rig.
[[nodiscard]] DetailedMesh in_shape(const DetailedMesh& detailed, std::size_t shape);
/// In a blend of all its shapes.
[[nodiscard]] DetailedMesh in_blend(const DetailedMesh& detailed,
                                    const std::vector<float>& weights);

}  // namespace varifold::test
