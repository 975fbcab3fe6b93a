// Based on: the glTF 2.0 specification, 3.11 (animations), appendix C (interpolation).
#include <varifold/mesh/rig_pose.h>

#include <varifold/base/angle.h>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace varifold {
namespace {

using DQuat = glm::dquat;

double sine(double radians) {
  constexpr double kTurn = 6.28318530717958647692;
  constexpr std::uint64_t kSteps = std::uint64_t{1} << 52;
  return unit_circle(static_cast<std::uint64_t>(radians / kTurn * static_cast<double>(kSteps)),
                     kSteps)
      .y;
}

DQuat normalized(const DQuat& q) {
  const double length = glm::length(q);
  return length > 0 ? q / length : DQuat(1, 0, 0, 0);
}

/// Along the shorter way.
DQuat spherical(const DQuat& from, DQuat to, double t) {
  double cosine = glm::dot(from, to);
  if (cosine < 0) {
    to = -to;
    cosine = -cosine;
  }
  constexpr double kNearlyStraight = 1 - 1e-7;
  if (cosine > kNearlyStraight) return normalized(from * (1 - t) + to * t);
  const double angle = arc_cosine(cosine);
  return normalized(from * sine((1 - t) * angle) + to * sine(t * angle));
}

DQuat quaternion_at(const float* values) { return {values[3], values[0], values[1], values[2]}; }

void store(const DQuat& q, std::span<float> values) {
  values[0] = static_cast<float>(q.x);
  values[1] = static_cast<float>(q.y);
  values[2] = static_cast<float>(q.z);
  values[3] = static_cast<float>(q.w);
}

/// The key before or at `time` and how far it is on the way to the next, in [0, 1].
struct KeyPlace {
  std::size_t key = 0;
  double fraction = 0;
  double seconds = 0;  ///< between the two
};

KeyPlace find_key(const std::vector<float>& times, float time) {
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (after == times.begin()) return {};
  const auto key = static_cast<std::size_t>(after - times.begin()) - 1;
  if (after == times.end()) return {key, 0, 0};
  const double seconds = double{*after} - double{times[key]};  // > 0, or upper_bound would go on
  return {key, (double{time} - double{times[key]}) / seconds, seconds};
}

/// `at`: the in-tangent, value and out-tangent of a key, `width` each, with those of the next
/// behind them.
void sample_spline(const float* at, std::size_t width, const KeyPlace& place,
                   std::span<float> values) {
  const double t = place.fraction;
  const double t2 = t * t;
  const double t3 = t2 * t;
  for (std::size_t i = 0; i < width; ++i) {
    const double value = at[width + i];
    const double out_tangent = at[2 * width + i];
    const double next_in_tangent = at[3 * width + i];
    const double next_value = at[4 * width + i];
    values[i] = static_cast<float>(
        (2 * t3 - 3 * t2 + 1) * value + place.seconds * (t3 - 2 * t2 + t) * out_tangent +
        (3 * t2 - 2 * t3) * next_value + place.seconds * (t3 - t2) * next_in_tangent);
  }
}

glm::dmat4 local_matrix(const RigNode& node) {
  if (node.has_matrix) return glm::dmat4(node.matrix);
  glm::dmat4 matrix = glm::mat4_cast(normalized(DQuat(node.rotation)));
  for (int i = 0; i < 3; ++i) matrix[i] *= double{node.scale[i]};
  matrix[3] = glm::dvec4(DVec3(node.translation), 1);
  return matrix;
}

void apply_channel(const AnimationChannel& channel, float time, RigPose& pose) {
  if (channel.times.empty()) return;
  if (channel.target == ChannelTarget::kPoseWeights) {
    assert(channel.index + channel.width <= pose.weights.size());
    sample_channel(channel, time, std::span(pose.weights).subspan(channel.index, channel.width));
    return;
  }
  std::array<float, 4> values{};
  sample_channel(channel, time, values);
  RigNode& node = pose.places[channel.index];
  const Vec3 vector(values[0], values[1], values[2]);
  if (channel.target == ChannelTarget::kTranslation)
    node.translation = vector;
  else if (channel.target == ChannelTarget::kScale)
    node.scale = vector;
  else
    node.rotation = Quat(values[3], values[0], values[1], values[2]);
}

}  // namespace

void sample_channel(const AnimationChannel& channel, float time, std::span<float> values) {
  assert(!channel.times.empty() && values.size() >= channel.width);
  const std::size_t width = channel.width;
  const KeyPlace place = find_key(channel.times, time);
  const bool is_spline = channel.interpolation == Interpolation::kCubicSpline;
  const float* const at = &channel.values[place.key * width * (is_spline ? 3 : 1)];
  const bool is_rotation = channel.target == ChannelTarget::kRotation;
  if (place.fraction == 0 || channel.interpolation == Interpolation::kStep) {
    std::copy_n(at + (is_spline ? width : 0), width, values.begin());
  } else if (is_spline) {
    sample_spline(at, width, place, values);
  } else if (is_rotation) {
    store(spherical(normalized(quaternion_at(at)), normalized(quaternion_at(at + width)),
                    place.fraction),
          values);
  } else {
    for (std::size_t i = 0; i < width; ++i)
      values[i] = static_cast<float>((1 - place.fraction) * at[i] + place.fraction * at[width + i]);
  }
  if (is_rotation) store(normalized(quaternion_at(values.data())), values);
}

TimeRange time_range(const Animation& animation) {
  TimeRange range;
  bool is_first = true;
  for (const AnimationChannel& channel : animation.channels) {
    if (channel.times.empty()) continue;
    range.first = is_first ? channel.times.front() : std::min(range.first, channel.times.front());
    range.last = is_first ? channel.times.back() : std::max(range.last, channel.times.back());
    is_first = false;
  }
  return range;
}

void pose_rig(const TriangleMesh& mesh, std::uint32_t animation, float time, RigPose& pose) {
  pose.weights.assign(mesh.poses.size(), 0);
  if (!mesh.rig) {
    pose.nodes.clear();
    pose.joints.clear();
    pose.places.clear();
    return;
  }
  const Rig& rig = *mesh.rig;
  std::copy_n(rig.pose_weights.begin(), std::min(rig.pose_weights.size(), pose.weights.size()),
              pose.weights.begin());
  pose.places = rig.nodes;
  if (animation != kNone)
    for (const AnimationChannel& channel : rig.animations[animation].channels)
      apply_channel(channel, time, pose);
  pose.nodes.resize(rig.nodes.size());
  for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
    const std::uint32_t parent = rig.nodes[n].parent;
    const glm::dmat4 local = local_matrix(pose.places[n]);
    pose.nodes[n] = parent == kNone ? local : pose.nodes[parent] * local;
  }
  pose.joints.resize(rig.joints.size());
  for (std::size_t j = 0; j < rig.joints.size(); ++j)
    pose.joints[j] = Mat4(pose.nodes[rig.joints[j].node] * glm::dmat4(rig.joints[j].inverse_bind));
}

RigPose pose_rig(const TriangleMesh& mesh, std::uint32_t animation, float time) {
  RigPose pose;
  pose_rig(mesh, animation, time, pose);
  return pose;
}

void posed_vertices(const TriangleMesh& mesh, const RigPose& pose, PosedVertices& result) {
  blend_poses(mesh, pose.weights, result);
  if (mesh.has_skin() && !pose.joints.empty()) skin_vertices(mesh.skin, pose.joints, result);
}

TriangleMesh posed_mesh(const TriangleMesh& mesh, std::uint32_t animation, float time) {
  PosedVertices vertices;
  posed_vertices(mesh, pose_rig(mesh, animation, time), vertices);
  return moved_mesh(mesh, std::move(vertices));
}

std::vector<Pose> sample_poses(const TriangleMesh& mesh, const PoseSampling& sampling) {
  std::vector<Pose> poses;
  if (!mesh.rig) return poses;
  RigPose rig;
  const std::uint32_t samples = sampling.samples_per_animation;
  for (std::uint32_t a = 0; a < mesh.rig->animations.size(); ++a) {
    const Animation& animation = mesh.rig->animations[a];
    const TimeRange range = time_range(animation);
    const std::string name =
        animation.name.empty() ? "animation " + std::to_string(a) : animation.name;
    for (std::uint32_t i = 0; i < samples; ++i) {
      const double part = samples == 1 ? 0 : static_cast<double>(i) / (samples - 1);
      const auto time = static_cast<float>((1 - part) * range.first + part * range.last);
      pose_rig(mesh, a, time, rig);
      PosedVertices vertices;
      posed_vertices(mesh, rig, vertices);
      poses.push_back({name + " " + std::to_string(i), std::move(vertices.positions),
                       std::move(vertices.normals)});
    }
  }
  return poses;
}

}  // namespace varifold
