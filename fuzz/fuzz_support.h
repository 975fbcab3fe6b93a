// What all fuzz targets share.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/imported_mesh.h>
#include <varifold/mesh/rig_pose.h>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace varifold::fuzz {

/// Stops the program, so that the fuzzer keeps the input, unless the condition holds.
inline void require(bool condition) {
  if (!condition) std::abort();
}

/// What moves the mesh is sound: it can be posed at rest and at the ends of its animations.
inline void check_motion(const TriangleMesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  require(mesh.skin.empty() || mesh.skin.size() == vertices);
  for (const Pose& pose : mesh.poses) {
    require(pose.positions.size() == vertices);
    require(pose.normals.empty() || pose.normals.size() == vertices);
  }
  if (mesh.skin.size() > 100000 || mesh.poses.size() > 100) return;  // slow
  require(posed_mesh(mesh, kNone, 0).positions.size() == vertices);
  if (!mesh.rig || mesh.rig->animations.empty()) return;
  const TimeRange range = time_range(mesh.rig->animations[0]);
  for (const float time : {range.first, 0.5f * range.last, range.last})
    require(posed_mesh(mesh, 0, time).positions.size() == vertices);
}

/// A result of a mesh reader is a sound mesh or a message of one line.
inline void check(const Result<ImportedMesh>& result) {
  if (!result) {
    const std::string& message = result.error().message;
    require(!message.empty() && message.find('\n') == std::string::npos);
    return;
  }
  const TriangleMesh& mesh = result->mesh;
  const std::size_t vertices = mesh.positions.size();
  require(mesh.indices.size() % 3 == 0);
  for (const std::uint32_t v : mesh.indices) require(v < vertices);
  for (const std::size_t size : {mesh.normals.size(), mesh.texcoords.size(), mesh.colors.size()})
    require(size == 0 || size == vertices);
  for (const Vec3& p : mesh.positions) require(p.x - p.x == 0 && p.y - p.y == 0 && p.z - p.z == 0);
  std::size_t covered = 0;
  for (const MaterialRange& range : mesh.ranges) {
    require(range.first_triangle == covered && range.material < mesh.materials.size());
    covered += range.triangle_count;
  }
  require(mesh.ranges.empty() || covered == mesh.triangle_count());
  check_motion(mesh);
}

inline std::span<const std::byte> bytes(const std::uint8_t* data, std::size_t size) {
  return std::as_bytes(std::span(data, size));
}

}  // namespace varifold::fuzz
