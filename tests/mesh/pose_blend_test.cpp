#include <varifold/mesh/pose_blend.h>

#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <tests/support/rigged_meshes.h>
#include <varifold/base/random.h>
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

namespace varifold {
namespace {

/// One vertex by the definition, in doubles.
DVec3 blended(const TriangleMesh& mesh, const std::vector<float>& weights, std::uint32_t v) {
  DVec3 sum = mesh.positions[v];
  for (std::size_t k = 0; k < mesh.poses.size(); ++k)
    sum += double{weights[k]} * (DVec3(mesh.poses[k].positions[v]) - DVec3(mesh.positions[v]));
  return sum;
}

// As long as the sum; poses without normals have those at rest.
DVec3 blended_normal(const TriangleMesh& mesh, const std::vector<float>& weights, std::uint32_t v) {
  const DVec3 rest = mesh.normals[v];
  DVec3 sum = rest;
  for (std::size_t k = 0; k < mesh.poses.size(); ++k)
    if (!mesh.poses[k].normals.empty())
      sum += double{weights[k]} * (DVec3(mesh.poses[k].normals[v]) - rest);
  return sum;
}

TEST(PoseBlend, IsTheSumOfWeightedDifferences) {
  Random random(1);
  for (const test::NamedMesh& group : test::all_groups()) {
    SCOPED_TRACE(group.name);
    const TriangleMesh mesh = test::with_random_rig(group.mesh, 7);
    for (int trial = 0; trial < 3; ++trial) {
      std::vector<float> weights;
      for (std::size_t k = 0; k < mesh.poses.size(); ++k)
        weights.push_back(static_cast<float>(3 * random.uniform() - 1));
      const PosedVertices found = blend_poses(mesh, weights);
      for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        const DVec3 expected = blended(mesh, weights, v);
        ASSERT_LE(glm::distance(DVec3(found.positions[v]), expected),
                  1e-7 * (1 + glm::length(expected)));
      }
      ASSERT_EQ(found.normals.size(), mesh.normals.size());
      for (std::uint32_t v = 0; v < found.normals.size(); ++v) {
        const DVec3 expected = blended_normal(mesh, weights, v);
        if (glm::length(expected) > 1e-3) {
          ASSERT_LT(glm::distance(DVec3(found.normals[v]), glm::normalize(expected)), 1e-3);
        }
      }
    }
  }
}

TEST(PoseBlend, GivesEveryPoseAndTheRestBitByBit) {
  for (const test::NamedMesh& group : test::all_groups()) {
    SCOPED_TRACE(group.name);
    const TriangleMesh mesh = test::with_random_rig(group.mesh, 8);
    for (const std::vector<float>& none : {std::vector<float>(), std::vector<float>(3, 0.0f)}) {
      EXPECT_EQ(blend_poses(mesh, none).positions, mesh.positions);
      EXPECT_EQ(blend_poses(mesh, none).normals, mesh.normals);
    }
    for (std::size_t k = 0; k < mesh.poses.size(); ++k) {
      std::vector<float> weights(mesh.poses.size(), 0.0f);
      weights[k] = 1;
      EXPECT_EQ(blend_poses(mesh, weights).positions, mesh.poses[k].positions);
    }
  }
}

TEST(PoseBlend, MakesAMeshThatMovesNoMore) {
  for (const test::NamedMesh& group : test::all_groups()) {
    SCOPED_TRACE(group.name);
    const TriangleMesh mesh = test::with_random_rig(group.mesh, 9);
    const std::vector<float> weights{0.5f, 0.25f};
    const TriangleMesh moved = blended_mesh(mesh, weights);
    EXPECT_EQ(moved.positions, blend_poses(mesh, weights).positions);
    EXPECT_EQ(moved.normals, blend_poses(mesh, weights).normals);
    EXPECT_EQ(moved.indices, mesh.indices);
    EXPECT_EQ(moved.ranges, mesh.ranges);
    EXPECT_EQ(moved.texcoords, mesh.texcoords);
    EXPECT_EQ(moved.colors, mesh.colors);
    EXPECT_EQ(moved.materials.size(), mesh.materials.size());
    EXPECT_TRUE(moved.poses.empty() && moved.skin.empty() && !moved.rig);
  }
}

// By the weight of every joint; of more than four the greatest.
TEST(MixJoints, IsTheMeanOfTheWeights) {
  Random random(4);
  const auto any = [&](std::uint32_t joints) {
    JointWeights made;
    float left = 1;
    for (std::size_t i = 0; i < 4; ++i) {
      made.joints[i] = static_cast<std::uint16_t>(i * joints + random.below(joints));
      made.weights[i] = i == 3 ? left : left * static_cast<float>(random.uniform());
      left -= made.weights[i];
    }
    return made;
  };
  const auto weight_of = [](const JointWeights& followed, std::uint16_t joint) {
    float sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      if (followed.joints[i] == joint) sum += followed.weights[i];
    return sum;
  };
  int cut = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::uint32_t joints = 1 + random.below(3);  // of each of the four places
    const JointWeights a = any(joints), b = any(joints);
    const float part = round % 5 == 0 ? 0 : static_cast<float>(random.uniform());
    const JointWeights mixed = mix_joints(a, b, part);
    std::vector<float> expected;
    for (std::uint16_t joint = 0; joint < 4 * joints; ++joint)
      expected.push_back((1 - part) * weight_of(a, joint) + part * weight_of(b, joint));
    std::vector<float> greatest = expected;
    std::sort(greatest.rbegin(), greatest.rend());
    float kept = 0;
    for (std::size_t i = 0; i < 4 && i < greatest.size(); ++i) kept += greatest[i];
    cut += kept < 0.999f ? 1 : 0;
    float sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      sum += mixed.weights[i];
      if (mixed.weights[i] > 0) {
        ASSERT_NEAR(mixed.weights[i], expected[mixed.joints[i]] / kept, 1e-5);
        ASSERT_GE(expected[mixed.joints[i]], greatest[3] - 1e-6);
      } else {
        ASSERT_EQ(mixed.joints[i], 0);
      }
    }
    ASSERT_NEAR(sum, 1, 1e-5);
  }
  EXPECT_GT(cut, 100);
}

TEST(SkinVertices, MoveByTheBlendOfMatrices) {
  Random random(2);
  const auto number = [&] { return static_cast<float>(2 * random.uniform() - 1); };
  for (const test::NamedMesh& group : test::all_groups()) {
    SCOPED_TRACE(group.name);
    const TriangleMesh mesh = test::with_random_rig(group.mesh, 10);
    std::vector<glm::mat4> matrices(5, glm::mat4(1));
    EXPECT_EQ(skin_vertices(mesh, matrices).positions, mesh.positions);
    for (glm::mat4& matrix : matrices)
      for (int i = 0; i < 12; ++i) matrix[i / 3][i % 3] = number();
    const PosedVertices found = skin_vertices(mesh, matrices);
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      DVec3 expected(0);
      glm::dmat3 linear(0);
      for (int i = 0; i < 4; ++i) {
        const glm::dmat4 matrix(matrices[mesh.skin[v].joints[i]]);
        const double weight = mesh.skin[v].weights[i];
        expected += weight * DVec3(matrix * glm::dvec4(DVec3(mesh.positions[v]), 1.0));
        linear += weight * glm::dmat3(matrix);
      }
      ASSERT_LE(glm::distance(DVec3(found.positions[v]), expected),
                1e-6 * (1 + glm::length(DVec3(mesh.positions[v]))));
      if (!mesh.has_normals() || std::abs(glm::determinant(linear)) < 1e-3) continue;
      const DVec3 normal =
          glm::normalize(glm::transpose(glm::inverse(linear)) * DVec3(mesh.normals[v]));
      ASSERT_LT(glm::distance(DVec3(found.normals[v]), normal), 1e-3);
    }
  }
}

}  // namespace
}  // namespace varifold
