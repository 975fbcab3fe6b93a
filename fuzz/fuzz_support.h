// What all fuzz targets share.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/imported_mesh.h>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace varifold::fuzz {

/// Stops the program, so that the fuzzer keeps the input, unless the condition holds.
inline void require(bool condition) {
  if (!condition) std::abort();
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
}

inline std::span<const std::byte> bytes(const std::uint8_t* data, std::size_t size) {
  return std::as_bytes(std::span(data, size));
}

}  // namespace varifold::fuzz
