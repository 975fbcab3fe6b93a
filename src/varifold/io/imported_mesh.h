// What every mesh reader returns.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <string>
#include <vector>

namespace varifold {

/// A mesh from a file, with one line for every kind of thing that was dropped or repaired on the
/// way. Guaranteed: all indices < vertex count, attribute arrays empty or one entry per vertex,
/// ranges as TriangleMesh demands, all positions and attributes finite.
struct ImportedMesh {
  TriangleMesh mesh;
  std::vector<std::string> warnings;
};

}  // namespace varifold
