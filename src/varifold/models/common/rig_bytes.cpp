#include <varifold/models/common/rig_bytes.h>

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <string_view>

namespace varifold {
namespace {

constexpr std::size_t kLeastNode = 4 + 4 + 1;
constexpr std::size_t kJointBytes = 4 + 16 * 4;
constexpr std::size_t kLeastChannel = 1 + 1 + 4 + 4 + 4;
constexpr std::size_t kLeastAnimation = 4 + 4;
constexpr std::size_t kLeastPose = 4 + 1;
constexpr std::size_t kMostJoints = 65536;

void append_string(std::vector<std::byte>& bytes, std::string_view text) {
  append_little(bytes, static_cast<std::uint32_t>(text.size()));
  append_text(bytes, text);
}

void append_floats(std::vector<std::byte>& bytes, const float* values, std::size_t count) {
  append_array(bytes, std::span(values, count));
}

// What is not finite fails.
void take_floats(SectionReader& section, float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = section.take<float>();
    if (!(values[i] - values[i] == 0)) section.fail_here();
  }
}

// `count` of them, where there are the bytes for them.
std::vector<float> take_float_array(SectionReader& section, std::uint64_t count) {
  std::vector<float> values = section.take_array<float>(count);
  for (const float value : values)
    if (!(value - value == 0)) section.fail_here();
  return values;
}

void append_node(const RigNode& node, std::vector<std::byte>& bytes) {
  append_string(bytes, node.name);
  append_little(bytes, node.parent);
  append_little(bytes, static_cast<std::uint8_t>(node.has_matrix ? 1 : 0));
  if (node.has_matrix) return append_floats(bytes, glm::value_ptr(node.matrix), 16);
  append_vector(bytes, node.translation, 3);
  append_vector(bytes, node.rotation, 4);
  append_vector(bytes, node.scale, 3);
}

RigNode take_node(SectionReader& section, std::uint32_t number) {
  RigNode node;
  node.name = section.take_string();
  node.parent = section.take<std::uint32_t>();
  if (node.parent != kNone && node.parent >= number) section.fail_here();
  const auto has_matrix = section.take<std::uint8_t>();
  if (has_matrix > 1) section.fail_here();
  node.has_matrix = has_matrix == 1;
  if (node.has_matrix) {
    take_floats(section, glm::value_ptr(node.matrix), 16);
    return node;
  }
  take_floats(section, glm::value_ptr(node.translation), 3);
  for (int i = 0; i < 4; ++i) take_floats(section, &node.rotation[i], 1);
  take_floats(section, glm::value_ptr(node.scale), 3);
  return node;
}

void append_channel(const AnimationChannel& channel, std::vector<std::byte>& bytes) {
  append_little(bytes, static_cast<std::uint8_t>(channel.target));
  append_little(bytes, static_cast<std::uint8_t>(channel.interpolation));
  append_little(bytes, channel.index);
  append_little(bytes, channel.width);
  append_little(bytes, static_cast<std::uint32_t>(channel.times.size()));
  append_floats(bytes, channel.times.data(), channel.times.size());
  append_floats(bytes, channel.values.data(), channel.values.size());
}

AnimationChannel take_channel(SectionReader& section, const Rig& rig, std::size_t pose_count) {
  AnimationChannel channel;
  const auto target = section.take<std::uint8_t>();
  const auto interpolation = section.take<std::uint8_t>();
  if (target > static_cast<std::uint8_t>(ChannelTarget::kPoseWeights) ||
      interpolation > static_cast<std::uint8_t>(Interpolation::kCubicSpline))
    section.fail_here();
  channel.target = static_cast<ChannelTarget>(target);
  channel.interpolation = static_cast<Interpolation>(interpolation);
  channel.index = section.take<std::uint32_t>();
  channel.width = section.take<std::uint32_t>();
  if (channel.target == ChannelTarget::kPoseWeights) {
    if (channel.width == 0 || channel.index > pose_count ||
        channel.width > pose_count - channel.index)
      section.fail_here();
  } else if (channel.index >= rig.nodes.size() ||
             channel.width != (channel.target == ChannelTarget::kRotation ? 4u : 3u)) {
    section.fail_here();
  }
  const auto keys = section.take<std::uint32_t>();
  const std::uint64_t sets = channel.interpolation == Interpolation::kCubicSpline ? 3 : 1;
  if (!section.good()) return channel;
  channel.times = take_float_array(section, keys);
  if (!section.good()) return channel;
  // By division, because the product may not fit 64 bits.
  if (keys > 0 && channel.width > section.remaining() / (sets * keys)) section.fail_here();
  if (!section.good()) return channel;
  channel.values = take_float_array(section, sets * keys * channel.width);
  if (!std::is_sorted(channel.times.begin(), channel.times.end())) section.fail_here();
  return channel;
}

}  // namespace

void append_rig(const Rig& rig, std::vector<std::byte>& bytes) {
  append_little(bytes, static_cast<std::uint32_t>(rig.nodes.size()));
  for (const RigNode& node : rig.nodes) append_node(node, bytes);
  append_little(bytes, static_cast<std::uint32_t>(rig.joints.size()));
  for (const Joint& joint : rig.joints) {
    append_little(bytes, joint.node);
    append_floats(bytes, glm::value_ptr(joint.inverse_bind), 16);
  }
  append_little(bytes, static_cast<std::uint32_t>(rig.pose_weights.size()));
  append_floats(bytes, rig.pose_weights.data(), rig.pose_weights.size());
  append_little(bytes, static_cast<std::uint32_t>(rig.animations.size()));
  for (const Animation& animation : rig.animations) {
    append_string(bytes, animation.name);
    append_little(bytes, static_cast<std::uint32_t>(animation.channels.size()));
    for (const AnimationChannel& channel : animation.channels) append_channel(channel, bytes);
  }
}

std::shared_ptr<const Rig> take_rig(SectionReader& section, std::size_t pose_count) {
  auto rig = std::make_shared<Rig>();
  const std::uint32_t nodes = section.take_count(kLeastNode);
  for (std::uint32_t i = 0; i < nodes && section.good(); ++i)
    rig->nodes.push_back(take_node(section, i));
  const std::uint32_t joints = section.take_count(kJointBytes);
  if (joints > kMostJoints) section.fail_here();
  for (std::uint32_t i = 0; i < joints && section.good(); ++i) {
    Joint joint;
    joint.node = section.take<std::uint32_t>();
    if (joint.node >= rig->nodes.size()) section.fail_here();
    take_floats(section, glm::value_ptr(joint.inverse_bind), 16);
    rig->joints.push_back(joint);
  }
  const auto weights = section.take<std::uint32_t>();
  if (weights != 0 && weights != pose_count) section.fail_here();
  if (section.good()) rig->pose_weights = take_float_array(section, weights);
  const std::uint32_t animations = section.take_count(kLeastAnimation);
  for (std::uint32_t i = 0; i < animations && section.good(); ++i) {
    Animation animation{std::string(section.take_string()), {}};
    const std::uint32_t channels = section.take_count(kLeastChannel);
    for (std::uint32_t c = 0; c < channels && section.good(); ++c)
      animation.channels.push_back(take_channel(section, *rig, pose_count));
    rig->animations.push_back(std::move(animation));
  }
  return section.good() ? rig : nullptr;
}

void append_pose_names(const std::vector<Pose>& poses, std::vector<std::byte>& bytes) {
  append_little(bytes, static_cast<std::uint32_t>(poses.size()));
  for (const Pose& pose : poses) {
    append_string(bytes, pose.name);
    append_little(bytes, static_cast<std::uint8_t>(pose.normals.empty() ? 0 : 1));
  }
}

PoseHead take_pose_names(SectionReader& section) {
  PoseHead head;
  const std::uint32_t count = section.take_count(kLeastPose);
  for (std::uint32_t i = 0; i < count && section.good(); ++i) {
    head.poses.push_back({std::string(section.take_string()), {}, {}});
    const auto has_normals = section.take<std::uint8_t>();
    if (has_normals > 1) section.fail_here();
    head.has_normals.push_back(has_normals == 1);
  }
  return head;
}

void append_joints(const JointWeights& followed, std::vector<std::byte>& bytes) {
  for (const std::uint16_t joint : followed.joints) append_little(bytes, joint);
  for (const float weight : followed.weights) append_little(bytes, weight);
}

JointWeights take_joints(SectionReader& section) {
  JointWeights followed;
  for (std::uint16_t& joint : followed.joints) joint = section.take<std::uint16_t>();
  for (float& weight : followed.weights) weight = section.take<float>();
  return followed;
}

bool is_sound(const JointWeights& followed, std::size_t joint_count) {
  const auto& [joints, weights] = followed;
  return std::all_of(joints.begin(), joints.end(),
                     [&](std::uint16_t joint) { return joint < joint_count; }) &&
         std::all_of(weights.begin(), weights.end(),
                     [](float weight) { return weight >= 0 && weight - weight == 0; });
}

}  // namespace varifold
