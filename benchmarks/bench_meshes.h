// The meshes that benchmarks work on, each loaded once.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <string>
#include <vector>

namespace varifold::bench {

/// "planet": the embedded planet with 1.3 million triangles; "planet_attributes": the same with
/// normals and colours; any other name: that file of the folder of real meshes. Where it is not
/// there, or is damaged, a mesh without triangles.
[[nodiscard]] const TriangleMesh& mesh(const std::string& name);

/// The names of `wanted` whose meshes are there.
[[nodiscard]] std::vector<std::string> present(const std::vector<std::string>& wanted);

/// Positions and triangles alone.
[[nodiscard]] TriangleMesh without_attributes(const TriangleMesh& mesh);

}  // namespace varifold::bench
