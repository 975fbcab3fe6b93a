// Based on: the glTF 2.0 specification, 3.7.2.2 (morph targets) and 3.7.3 (skins).
// Differs: normals follow the inverse transpose of blended matrices, which the specification leaves
// open.
#include <varifold/mesh/pose_blend.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <glm/mat3x3.hpp>
#include <utility>

namespace varifold {
namespace {

constexpr std::size_t kBlock = 256;

/// Blends one array; `values_of(pose)` may be empty, which counts as `rest`.
template <class ValuesOf>
void blend(const std::vector<Vec3>& rest, const std::vector<Pose>& poses,
           std::span<const float> weights, const ValuesOf& values_of, std::vector<Vec3>& result) {
  result.resize(rest.size());
  const std::size_t count = std::min(poses.size(), weights.size());
  for (std::size_t first = 0; first < rest.size(); first += kBlock) {
    const std::size_t size = std::min(kBlock, rest.size() - first);
    std::array<DVec3, kBlock> sums;
    for (std::size_t i = 0; i < size; ++i) sums[i] = rest[first + i];
    for (std::size_t k = 0; k < count; ++k) {
      const std::vector<Vec3>& values = values_of(poses[k]);
      if (weights[k] == 0 || values.empty()) continue;
      const double weight = weights[k];
      for (std::size_t i = 0; i < size; ++i)
        sums[i] += weight * (DVec3(values[first + i]) - DVec3(rest[first + i]));
    }
    for (std::size_t i = 0; i < size; ++i) result[first + i] = Vec3(sums[i]);
  }
}

}  // namespace

void blend_poses(const TriangleMesh& mesh, std::span<const float> weights, PosedVertices& result) {
  blend(
      mesh.positions, mesh.poses, weights,
      [](const Pose& pose) -> const std::vector<Vec3>& { return pose.positions; },
      result.positions);
  blend(
      mesh.normals, mesh.poses, weights,
      [](const Pose& pose) -> const std::vector<Vec3>& { return pose.normals; }, result.normals);
  const auto used = weights.first(std::min(weights.size(), mesh.poses.size()));
  const bool at_rest = std::all_of(used.begin(), used.end(), [](float w) { return w == 0; });
  if (at_rest) return;
  for (Vec3& normal : result.normals) normal = normalize_or_zero(normal);
}

PosedVertices blend_poses(const TriangleMesh& mesh, std::span<const float> weights) {
  PosedVertices result;
  blend_poses(mesh, weights, result);
  return result;
}

void skin_vertices(std::span<const JointWeights> skin, std::span<const glm::mat4> joint_matrices,
                   PosedVertices& vertices) {
  assert(skin.size() == vertices.positions.size());
  for (std::size_t v = 0; v < skin.size(); ++v) {
    glm::mat4 matrix(0);
    for (std::size_t i = 0; i < 4; ++i)
      if (skin[v].weights[i] != 0) matrix += skin[v].weights[i] * joint_matrices[skin[v].joints[i]];
    vertices.positions[v] = Vec3(matrix * Vec4(vertices.positions[v], 1));
    if (vertices.normals.empty()) continue;
    // The matrix of cofactors is the inverse transpose times the determinant, and always exists.
    const glm::mat3 linear(matrix);
    glm::mat3 cofactors;
    for (int i = 0; i < 3; ++i) cofactors[i] = glm::cross(linear[(i + 1) % 3], linear[(i + 2) % 3]);
    const float sign = glm::dot(linear[0], cofactors[0]) < 0 ? -1.0f : 1.0f;
    vertices.normals[v] = normalize_or_zero(sign * (cofactors * vertices.normals[v]));
  }
}

PosedVertices skin_vertices(const TriangleMesh& mesh, std::span<const glm::mat4> joint_matrices) {
  PosedVertices result{mesh.positions, mesh.normals};
  skin_vertices(mesh.skin, joint_matrices, result);
  return result;
}

JointWeights mix_joints(const JointWeights& from, const JointWeights& to, float part) {
  struct Weighted {
    std::uint16_t joint;
    float weight;
  };
  std::array<Weighted, 8> all{};
  std::size_t count = 0;
  const auto add = [&](const JointWeights& followed, float factor) {
    for (std::size_t i = 0; i < 4; ++i) {
      const float weight = factor * followed.weights[i];
      if (!(weight > 0)) continue;
      const auto same = std::find_if(all.begin(), all.begin() + count, [&](const Weighted& known) {
        return known.joint == followed.joints[i];
      });
      if (same == all.begin() + count) all[count++] = {followed.joints[i], 0};
      same->weight += weight;
    }
  };
  add(from, 1 - part);
  add(to, part);
  const auto is_less = [](const Weighted& a, const Weighted& b) {
    return a.weight != b.weight ? a.weight < b.weight : a.joint > b.joint;
  };
  JointWeights mixed;
  float sum = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(count, 4); ++i) {
    std::swap(all[i], *std::max_element(all.begin() + i, all.begin() + count, is_less));
    mixed.joints[i] = all[i].joint;
    sum += mixed.weights[i] = all[i].weight;
  }
  for (float& weight : mixed.weights) weight = sum > 0 ? weight / sum : 0;
  return mixed;
}

TriangleMesh moved_mesh(const TriangleMesh& mesh, PosedVertices vertices) {
  TriangleMesh result;
  result.positions = std::move(vertices.positions);
  result.normals = std::move(vertices.normals);
  result.texcoords = mesh.texcoords;
  result.colors = mesh.colors;
  result.indices = mesh.indices;
  result.ranges = mesh.ranges;
  result.materials = mesh.materials;
  result.images = mesh.images;
  return result;
}

TriangleMesh blended_mesh(const TriangleMesh& mesh, std::span<const float> weights) {
  return moved_mesh(mesh, blend_poses(mesh, weights));
}

}  // namespace varifold
