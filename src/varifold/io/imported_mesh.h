// What every mesh reader returns.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <string>
#include <vector>

namespace varifold {

/// A mesh from a file, with one line for every kind of thing that was dropped or repaired on the
/// way. Guaranteed: all indices < vertex count, attribute arrays empty or one entry per vertex,
/// ranges as TriangleMesh demands, all positions and attributes finite.
struct ImportedMesh {
  TriangleMesh mesh;
  std::vector<std::string> warnings;
  /// Of OBJ files whose faces have texture coordinates or normals: which `v`, from 0, each vertex
  /// came from. Elsewhere empty: the vertices are those of the file, or have none to be named by.
  std::vector<std::uint32_t> file_vertices;
};

/// What becomes of the faces of PLY and OBJ files.
enum class FaceReading {
  kForUse,    ///< concave polygons are cut by their shape, triangles are sorted by material
  kAsInFile,  ///< every polygon is a fan, in the order of the file, without materials: two files
              ///< that differ in places and attributes alone give the same triangles
};

}  // namespace varifold
