#include <varifold/simplify/input_fault.h>

#include <cmath>

namespace varifold {

namespace {

bool is_finite(const Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

std::string pose_fault(const TriangleMesh& mesh, const Pose& pose) {
  if (pose.positions.size() != mesh.positions.size())
    return std::to_string(pose.positions.size()) + " positions for " +
           std::to_string(mesh.positions.size()) + " vertices";
  if (!pose.normals.empty() && pose.normals.size() != mesh.positions.size())
    return std::to_string(pose.normals.size()) + " normals for " +
           std::to_string(mesh.positions.size()) + " vertices";
  for (std::size_t v = 0; v < pose.positions.size(); ++v)
    if (!is_finite(pose.positions[v]))
      return "vertex " + std::to_string(v) + " has a position that is not finite";
  return {};
}

}  // namespace

std::string input_fault(const TriangleMesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  if (vertices >= kNone || mesh.indices.size() / 3 >= kNone / 3)
    return "mesh too large for 32 bits";
  if (mesh.indices.size() % 3 != 0) return "the number of indices is no multiple of three";
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    if (mesh.indices[i] >= vertices)
      return "triangle " + std::to_string(i / 3) + " uses vertex " +
             std::to_string(mesh.indices[i]) + " of " + std::to_string(vertices);
  for (std::size_t v = 0; v < vertices; ++v)
    if (!is_finite(mesh.positions[v]))
      return "vertex " + std::to_string(v) + " has a position that is not finite";
  const auto fits = [&](std::size_t size) { return size == 0 || size == vertices; };
  if (!fits(mesh.normals.size()) || !fits(mesh.texcoords.size()) || !fits(mesh.colors.size()) ||
      !fits(mesh.skin.size()))
    return "an attribute array has another size than the positions";
  for (std::size_t i = 0; i < mesh.poses.size(); ++i)
    if (std::string found = pose_fault(mesh, mesh.poses[i]); !found.empty())
      return "pose " + std::to_string(i + 1) + ": " + found;
  std::uint32_t next = 0;
  for (const MaterialRange& range : mesh.ranges) {
    if (range.first_triangle != next || range.triangle_count > mesh.triangle_count() - next)
      return "the material ranges do not cover the triangles in order";
    next += range.triangle_count;
  }
  if (!mesh.ranges.empty() && next != mesh.triangle_count())
    return "the material ranges do not cover all triangles";
  return {};
}

std::string sample_fault(const TriangleMesh& mesh, std::span<const Pose> samples) {
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (std::string found = pose_fault(mesh, samples[i]); !found.empty())
      return "sample " + std::to_string(i) + " of poses: " + found;
  return {};
}

}  // namespace varifold
