// What moves a mesh: nodes, joints and animations, as in glTF 2.0.
#pragma once

#include <varifold/base/math.h>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

namespace varifold {

using Mat4 = glm::mat4;
using Quat = glm::quat;

/// A place relative to its parent: either a matrix or translation * rotation * scale. Only the
/// latter can be animated.
struct RigNode {
  std::string name;
  std::uint32_t parent = kNone;  ///< always before its children
  bool has_matrix = false;
  Mat4 matrix{1};
  Vec3 translation{0};
  Quat rotation{1, 0, 0, 0};
  Vec3 scale{1};
  friend bool operator==(const RigNode&, const RigNode&) = default;
};

struct Joint {
  std::uint32_t node = 0;  ///< in Rig::nodes
  Mat4 inverse_bind{1};    ///< from the mesh to the joint's own frame in the pose of the binding
  friend bool operator==(const Joint&, const Joint&) = default;
};

enum class ChannelTarget : std::uint8_t { kTranslation, kRotation, kScale, kPoseWeights };
enum class Interpolation : std::uint8_t { kStep, kLinear, kCubicSpline };

/// How one property changes with time.
struct AnimationChannel {
  ChannelTarget target = ChannelTarget::kTranslation;
  /// The node; for weights of poses the first of TriangleMesh::poses that it moves.
  std::uint32_t index = 0;
  std::uint32_t width = 3;  ///< values a key: 3, 4 (x, y, z, w), 3 or the number of poses
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times;   ///< seconds, ascending
  std::vector<float> values;  ///< `width` a key; with kCubicSpline in-tangent, value, out-tangent
  friend bool operator==(const AnimationChannel&, const AnimationChannel&) = default;
};

struct Animation {
  std::string name;
  std::vector<AnimationChannel> channels;
  friend bool operator==(const Animation&, const Animation&) = default;
};

/// Immutable and shared by all levels of a mesh.
///
/// Joints move the vertices that follow them from the space of the mesh to the world: see
/// rig_pose.h. All numbers are finite, nodes come after their parents, and indices are in range.
struct Rig {
  std::vector<RigNode> nodes;
  std::vector<Joint> joints;
  std::vector<float> pose_weights;  ///< of TriangleMesh::poses where nothing is animated; or empty
  std::vector<Animation> animations;
  friend bool operator==(const Rig&, const Rig&) = default;
};

}  // namespace varifold
