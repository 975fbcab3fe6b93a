// Vertices of a mesh between its poses and under the joints of its skin.
#pragma once

#include <varifold/base/math.h>
#include <varifold/mesh/triangle_mesh.h>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

namespace varifold {

/// Places and normals of the vertices of a mesh that has been moved.
struct PosedVertices {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  ///< empty, or units (zero where there is no direction)
};

/// The blend P + sum w_k (P_k - P) of the shape at rest P and all poses P_k; the same for normals,
/// which become units, where a pose without normals counts as one with those at rest. Weights may
/// have any value; those that are missing are 0. Sums are in double precision: a weight of 1 alone
/// gives that pose, and no weights give the mesh at rest, bit by bit.
/// O(vertices * weights that are not 0); allocates nothing where `result` has room.
void blend_poses(const TriangleMesh& mesh, std::span<const float> weights, PosedVertices& result);
[[nodiscard]] PosedVertices blend_poses(const TriangleMesh& mesh, std::span<const float> weights);

/// Moves every vertex by the blend of the matrices of its joints, its normal by the inverse
/// transpose of that. `joint_matrices` has one for each joint of the rig (rig_pose.h); `vertices`
/// are those of the mesh, blended or at rest. O(vertices); allocates nothing.
void skin_vertices(std::span<const JointWeights> skin, std::span<const glm::mat4> joint_matrices,
                   PosedVertices& vertices);
/// The same for the mesh at rest.
[[nodiscard]] PosedVertices skin_vertices(const TriangleMesh& mesh,
                                          std::span<const glm::mat4> joint_matrices);

/// Joints on the way from `from` (part 0) to `to` (part 1): the mean of the weights, of more than
/// four joints the four greatest, which then sum up to 1. The ends are as they are but for the
/// order of joints. O(1).
[[nodiscard]] JointWeights mix_joints(const JointWeights& from, const JointWeights& to, float part);

/// The mesh with its vertices there, a mesh of its own: without poses, skin and rig. O(mesh).
[[nodiscard]] TriangleMesh moved_mesh(const TriangleMesh& mesh, PosedVertices vertices);
/// The mesh in the blend of its poses, in the same way.
[[nodiscard]] TriangleMesh blended_mesh(const TriangleMesh& mesh, std::span<const float> weights);

}  // namespace varifold
