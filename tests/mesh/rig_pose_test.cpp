#include <varifold/mesh/rig_pose.h>

#include <gtest/gtest.h>
#include <tests/support/count_allocations.h>
#include <tests/support/meshes.h>
#include <tests/support/rigged_meshes.h>
#include <varifold/base/random.h>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>

namespace varifold {
namespace {

std::vector<float> sampled(const AnimationChannel& channel, float time) {
  std::vector<float> values(channel.width);
  sample_channel(channel, time, values);
  return values;
}

TEST(SampleChannel, StepsAndLinesPassThroughTheirKeys) {
  AnimationChannel channel;
  channel.times = {1, 2, 4};
  channel.values = {0, 10, 20, 1, 12, 24, 5, 5, 5};
  using Values = std::vector<float>;
  EXPECT_EQ(sampled(channel, 0), (Values{0, 10, 20}));
  EXPECT_EQ(sampled(channel, 1), (Values{0, 10, 20}));
  EXPECT_EQ(sampled(channel, 1.5f), (Values{0.5f, 11, 22}));
  EXPECT_EQ(sampled(channel, 3.5f), (Values{4, 6.75f, 9.75f}));
  EXPECT_EQ(sampled(channel, 9), (Values{5, 5, 5}));
  channel.interpolation = Interpolation::kStep;
  EXPECT_EQ(sampled(channel, 1.9f), (Values{0, 10, 20}));
  EXPECT_EQ(sampled(channel, 2), (Values{1, 12, 24}));
  EXPECT_EQ(sampled(channel, 9), (Values{5, 5, 5}));
  channel.times = {1, 1, 1};  // a jump has no length
  channel.interpolation = Interpolation::kLinear;
  EXPECT_EQ(sampled(channel, 1), (Values{5, 5, 5}));
}

TEST(SampleChannel, SplinesReproduceCubics) {
  // The keys of a cubic polynomial with its derivatives give it back.
  const auto value = [](double t) { return 1 + 2 * t - 3 * t * t + 0.5 * t * t * t; };
  const auto slope = [](double t) { return 2 - 6 * t + 1.5 * t * t; };
  AnimationChannel channel;
  channel.target = ChannelTarget::kPoseWeights;
  channel.width = 1;
  channel.interpolation = Interpolation::kCubicSpline;
  for (const double t : {0.5, 1.0, 3.0}) {
    channel.times.push_back(static_cast<float>(t));
    for (const double x : {slope(t), value(t), slope(t)})
      channel.values.push_back(static_cast<float>(x));
  }
  for (double t = 0.5; t <= 3; t += 0.03125)
    EXPECT_NEAR(sampled(channel, static_cast<float>(t))[0], value(t), 1e-5) << t;
}

TEST(SampleChannel, RotationsTurnEvenlyTheShortWay) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, -0.5));
  for (const double degrees : {0.001, 1.0, 90.0, 179.0}) {
    for (const double sign : {1.0, -1.0}) {
      const auto at = [&](double part) {
        const double half = part * degrees * 0.0087266462599716478846;
        return glm::dquat(std::cos(half), axis * std::sin(half));
      };
      AnimationChannel channel{ChannelTarget::kRotation, 0, 4, Interpolation::kLinear, {0, 2}, {}};
      for (const double part : {0.0, 1.0}) {
        const glm::dquat q = at(part) * (part == 1 ? sign : 1.0);  // both signs are one rotation
        for (const double x : {q.x, q.y, q.z, q.w}) channel.values.push_back(static_cast<float>(x));
      }
      for (double part = 0; part < 1; part += 0.0625) {
        const std::vector<float> found = sampled(channel, static_cast<float>(2 * part));
        const glm::dquat q(found[3], found[0], found[1], found[2]);
        EXPECT_NEAR(std::abs(glm::dot(q, at(part))), 1, 1e-7);
        EXPECT_NEAR(glm::length(q * glm::conjugate(at(part)) - glm::dquat(1, 0, 0, 0)), 0, 1e-6)
            << degrees << " degrees, " << part;
      }
    }
  }
}

/// The matrix of a node by the definition, with an independent product of matrices.
glm::dmat4 node_matrix(const RigPose& pose, const Rig& rig, std::uint32_t node) {
  const RigNode& place = pose.places[node];
  glm::dmat4 local(place.matrix);
  if (!rig.nodes[node].has_matrix) {
    const glm::dquat q(place.rotation);
    local = glm::translate(glm::dmat4(1), glm::dvec3(place.translation)) *
            glm::mat4_cast(glm::normalize(q)) * glm::scale(glm::dmat4(1), glm::dvec3(place.scale));
  }
  const std::uint32_t parent = rig.nodes[node].parent;
  return parent == kNone ? local : node_matrix(pose, rig, parent) * local;
}

TEST(PoseRig, JointsAreTheirNodesTimesInverseBinds) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TriangleMesh mesh = test::with_random_rig(test::octahedron(), seed, {2, 12, 3});
    for (const std::uint32_t animation : {kNone, 0u, 1u, 2u}) {
      for (const float time : {0.0f, 0.7f, 1.3f, 9.0f}) {
        const RigPose pose = pose_rig(mesh, animation, time);
        for (std::size_t j = 0; j < mesh.rig->joints.size(); ++j) {
          const Joint& joint = mesh.rig->joints[j];
          const glm::dmat4 expected =
              node_matrix(pose, *mesh.rig, joint.node) * glm::dmat4(joint.inverse_bind);
          for (int c = 0; c < 16; ++c)
            ASSERT_NEAR(pose.joints[j][c / 4][c % 4], expected[c / 4][c % 4], 1e-5);
        }
        if (animation == kNone) {
          EXPECT_EQ(pose.places, mesh.rig->nodes);
          EXPECT_EQ(pose.weights, mesh.rig->pose_weights);
        }
      }
    }
  }
}

TEST(PoseRig, ChannelsSetWhatTheyName) {
  const TriangleMesh mesh = test::with_random_rig(test::octahedron(), 3, {2, 6, 1});
  const float time = 0.9f;
  const RigPose pose = pose_rig(mesh, 0, time);
  for (const AnimationChannel& channel : mesh.rig->animations[0].channels) {
    const std::vector<float> values = sampled(channel, time);
    const RigNode* const node =
        channel.target == ChannelTarget::kPoseWeights ? nullptr : &pose.places[channel.index];
    switch (channel.target) {
      case ChannelTarget::kPoseWeights:
        EXPECT_EQ(pose.weights, values);
        break;
      case ChannelTarget::kTranslation:
        EXPECT_EQ(node->translation, Vec3(values[0], values[1], values[2]));
        break;
      case ChannelTarget::kScale:
        EXPECT_EQ(node->scale, Vec3(values[0], values[1], values[2]));
        break;
      case ChannelTarget::kRotation:
        EXPECT_EQ(node->rotation, Quat(values[3], values[0], values[1], values[2]));
        break;
    }
  }
}

TEST(PosedMesh, IsBlendedFirstAndSkinnedThen) {
  for (const test::NamedMesh& group : test::all_groups()) {
    SCOPED_TRACE(group.name);
    const TriangleMesh mesh = test::with_random_rig(group.mesh, 5);
    const TriangleMesh frozen = posed_mesh(mesh, 1, 0.6f);
    EXPECT_TRUE(frozen.skin.empty() && frozen.poses.empty() && !frozen.rig);
    EXPECT_EQ(frozen.indices, mesh.indices);
    EXPECT_EQ(frozen.texcoords, mesh.texcoords);
    EXPECT_EQ(frozen.ranges, mesh.ranges);
    const RigPose pose = pose_rig(mesh, 1, 0.6f);
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      DVec3 place = mesh.positions[v];
      for (std::size_t k = 0; k < mesh.poses.size(); ++k)
        place += double{pose.weights[k]} *
                 (DVec3(mesh.poses[k].positions[v]) - DVec3(mesh.positions[v]));
      DVec3 expected(0);
      for (int i = 0; i < 4; ++i)
        expected += double{mesh.skin[v].weights[i]} *
                    DVec3(glm::dmat4(pose.joints[mesh.skin[v].joints[i]]) * glm::dvec4(place, 1.0));
      ASSERT_LE(glm::distance(DVec3(frozen.positions[v]), expected),
                1e-5 * (1 + glm::length(expected)));
    }
  }
}

TEST(SamplePoses, GoFromTheFirstKeyToTheLast) {
  const TriangleMesh mesh = test::with_random_rig(test::icosphere(80), 6);
  const std::vector<Pose> poses = sample_poses(mesh, {5});
  ASSERT_EQ(poses.size(), 10u);
  for (std::uint32_t a = 0; a < 2; ++a) {
    const TimeRange range = time_range(mesh.rig->animations[a]);
    EXPECT_LT(range.first, range.last);
    EXPECT_EQ(poses[5 * a].positions, posed_mesh(mesh, a, range.first).positions);
    EXPECT_EQ(poses[5 * a + 4].positions, posed_mesh(mesh, a, range.last).positions);
    EXPECT_EQ(poses[5 * a + 2].positions,
              posed_mesh(mesh, a, static_cast<float>(0.5 * (double{range.first} + range.last)))
                  .positions);
    EXPECT_EQ(poses[5 * a + 4].name, "animation " + std::to_string(a) + " 4");
  }
  EXPECT_EQ(sample_poses(mesh, {5}), poses);
  EXPECT_EQ(sample_poses(mesh, {1})[1].positions, poses[5].positions);
  EXPECT_TRUE(sample_poses(test::icosphere(80)).empty());
}

TEST(PoseRig, AllocatesNothingTheSecondTime) {
  const TriangleMesh mesh = test::with_random_rig(test::icosphere(80), 6);
  RigPose pose;
  PosedVertices vertices;
  pose_rig(mesh, 0, 0.5f, pose);
  posed_vertices(mesh, pose, vertices);
  const std::size_t before = allocations;
  pose_rig(mesh, 1, 0.75f, pose);
  posed_vertices(mesh, pose, vertices);
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace varifold
