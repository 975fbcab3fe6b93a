// A rig as bytes: what model formats store of meshes that move.
#pragma once

#include <varifold/mesh/rig.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/common/section_reader.h>
#include <cstddef>
#include <memory>
#include <vector>

namespace varifold {

void append_rig(const Rig& rig, std::vector<std::byte>& bytes);

/// What append_rig() appended, for a mesh of so many poses. Null, and section.good() is false
/// afterwards, where bytes are missing or what they say breaks what Rig promises. No more is
/// allocated than the bytes justify.
[[nodiscard]] std::shared_ptr<const Rig> take_rig(SectionReader& section, std::size_t pose_count);

/// The names of poses and which of them have normals.
void append_pose_names(const std::vector<Pose>& poses, std::vector<std::byte>& bytes);

/// The poses of append_pose_names() without vertices, and for each whether it has normals.
struct PoseHead {
  std::vector<Pose> poses;
  std::vector<bool> has_normals;
};
[[nodiscard]] PoseHead take_pose_names(SectionReader& section);

inline constexpr std::size_t kJointWeightsBytes = 4 * 2 + 4 * 4;
void append_joints(const JointWeights& followed, std::vector<std::byte>& bytes);
[[nodiscard]] JointWeights take_joints(SectionReader& section);

/// Whether all joints that a vertex follows are there and its weights are finite and not negative.
[[nodiscard]] bool is_sound(const JointWeights& followed, std::size_t joint_count);

}  // namespace varifold
