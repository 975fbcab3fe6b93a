#include <tests/support/poses.h>
#include <varifold/base/random.h>
#include <cmath>
#include <numeric>

namespace varifold::test {

Pose bent_pose(const TriangleMesh& mesh, std::uint64_t seed, float strength) {
  Random random(seed);
  Box box;
  for (const Vec3& p : mesh.positions) box.add(p);
  const float size = std::max(box.diagonal(), 1e-6f);
  const auto any = [&] { return static_cast<float>(2 * random.uniform() - 1); };
  Vec3 along[3], push[3];
  float phase[3];
  for (int i = 0; i < 3; ++i) {
    along[i] = 6.0f / size * Vec3(any(), any(), any());
    push[i] = strength * size * Vec3(any(), any(), any());
    phase[i] = 3 * any();
  }
  const float twist = 4 * strength * any() / size;
  Pose pose;
  pose.name = "bent " + std::to_string(seed);
  for (const Vec3& p : mesh.positions) {
    const Vec3 q = p - box.center();
    const float angle = twist * q.z;
    Vec3 moved(std::cos(angle) * q.x - std::sin(angle) * q.y,
               std::sin(angle) * q.x + std::cos(angle) * q.y, q.z);
    for (int i = 0; i < 3; ++i) moved += std::sin(glm::dot(along[i], q) + phase[i]) * push[i];
    pose.positions.push_back(box.center() + moved);
  }
  return pose;
}

TriangleMesh with_poses(TriangleMesh mesh, std::uint32_t count, std::uint64_t seed,
                        float strength) {
  for (std::uint32_t i = 0; i < count; ++i)
    mesh.poses.push_back(bent_pose(mesh, 1000 * seed + i, strength));
  return mesh;
}

Pose turned_pose(const TriangleMesh& mesh, std::uint64_t seed, float angle) {
  Random random(seed);
  Box box;
  for (const Vec3& p : mesh.positions) box.add(p);
  const float turn = 6.2831853f;
  Vec3 phase, axis;
  for (int k = 0; k < 3; ++k) {
    phase[k] = turn * static_cast<float>(random.uniform());
    axis[k] = static_cast<float>(2 * random.uniform() - 1);
  }
  axis = normalize_or_zero(axis);
  Pose pose;
  pose.name = "turned " + std::to_string(seed);
  for (const Vec3& p : mesh.positions) {
    Vec3 q = p - box.center();
    for (int k = 0; k < 3; ++k) {
      const float size = std::max(box.upper[k] - box.lower[k], 1e-6f);
      // Below 1, so that the order along the axis stays.
      q[k] += 0.9f * size / turn * std::sin(turn * q[k] / size + phase[k]);
    }
    const Vec3 along = glm::dot(axis, q) * axis;
    q = along + std::cos(angle) * (q - along) + std::sin(angle) * glm::cross(axis, q);
    pose.positions.push_back(box.center() + q);
  }
  return pose;
}

TriangleMesh with_turned_poses(TriangleMesh mesh, std::uint32_t count, std::uint64_t seed,
                               float angle) {
  for (std::uint32_t i = 0; i < count; ++i)
    mesh.poses.push_back(turned_pose(mesh, 1000 * seed + i, angle));
  return mesh;
}

std::vector<float> blend_weights(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> weights(count, 0);
  if (seed % 3 == 0) {
    weights[random.below(static_cast<std::uint32_t>(count))] = 1;
    return weights;
  }
  if (seed % 3 == 1) {
    const auto t = static_cast<float>(random.uniform());
    weights[random.below(static_cast<std::uint32_t>(count))] += t;
    weights[random.below(static_cast<std::uint32_t>(count))] += 1 - t;
    return weights;
  }
  for (float& weight : weights) weight = static_cast<float>(random.uniform());
  const float sum = std::accumulate(weights.begin(), weights.end(), 0.0f);
  for (float& weight : weights) weight /= sum;
  return weights;
}

DetailedMesh in_shape(const DetailedMesh& detailed, std::size_t shape) {
  std::vector<float> weights(detailed.shapes().size(), 0);
  weights[shape] = 1;
  return in_blend(detailed, weights);
}

DetailedMesh in_blend(const DetailedMesh& detailed, const std::vector<float>& weights) {
  const auto shapes = detailed.shapes();
  DetailedMesh blended = detailed;
  blended.mesh.poses.clear();
  blended.mesh.skin.clear();
  blended.mesh.rig.reset();
  blended.mesh.normals.clear();
  blended.samples.clear();
  for (std::uint32_t v = 0; v < detailed.mesh.vertex_count(); ++v) {
    DVec3 sum(0);
    for (std::size_t i = 0; i < shapes.size(); ++i)
      sum += static_cast<double>(weights[i]) * DVec3(shapes[i][v]);
    blended.mesh.positions[v] = Vec3(sum);
  }
  return blended;
}

}  // namespace varifold::test
