// A rig at a time of an animation.
#pragma once

#include <varifold/mesh/pose_blend.h>
#include <varifold/mesh/rig.h>
#include <varifold/mesh/triangle_mesh.h>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

namespace varifold {

/// The value of a channel at a time in seconds: channel.width numbers; rotations are units. Before
/// the first and after the last key it is that of the key. O(log keys + width), allocates nothing.
void sample_channel(const AnimationChannel& channel, float time, std::span<float> values);

/// First and last key of all channels of an animation, in seconds; 0, 0 without keys.
struct TimeRange {
  float first = 0;
  float last = 0;
};
[[nodiscard]] TimeRange time_range(const Animation& animation);

/// Where everything is at one time.
struct RigPose {
  std::vector<glm::dmat4> nodes;  ///< from each node to the world
  std::vector<Mat4> joints;       ///< of each joint: from the mesh to the world
  std::vector<float> weights;     ///< of each of TriangleMesh::poses
  std::vector<RigNode> places;    ///< of each node relative to its parent
};

/// The rig of a mesh at a time of one of its animations; at rest with `animation` kNone, or where
/// the mesh has no rig. Allocates nothing where `pose` was made for the same mesh before.
/// O(nodes + joints + poses + channels * log keys).
void pose_rig(const TriangleMesh& mesh, std::uint32_t animation, float time, RigPose& pose);
[[nodiscard]] RigPose pose_rig(const TriangleMesh& mesh, std::uint32_t animation, float time);

/// The vertices of the mesh in that pose: poses are blended first, then the skin moves them.
void posed_vertices(const TriangleMesh& mesh, const RigPose& pose, PosedVertices& result);

/// The mesh frozen in that pose, in the world: without skin, poses and rig. O(mesh).
[[nodiscard]] TriangleMesh posed_mesh(const TriangleMesh& mesh, std::uint32_t animation,
                                      float time);

struct PoseSampling {
  /// At equal distances from the first to the last key, both included; 1: the first key alone.
  std::uint32_t samples_per_animation = 16;
};

/// The shapes that the mesh takes over all its animations, in their order, in the world; each is
/// named by its animation and its number. Normals where the mesh has them. Empty for a mesh without
/// animations. O(samples * vertices).
[[nodiscard]] std::vector<Pose> sample_poses(const TriangleMesh& mesh,
                                             const PoseSampling& sampling = {});

}  // namespace varifold
