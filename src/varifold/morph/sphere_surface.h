// A mesh judged to be a sphere: what can be laid onto one.
#pragma once

#include <varifold/base/result.h>
#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <string>
#include <vector>

namespace varifold {

/// The points (used position classes) of a mesh and its triangles over them.
struct SphereSurface {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> triangles;        ///< per triangle here, that of the mesh
  std::vector<std::uint32_t> point_of_vertex;  ///< per vertex of the mesh; kNone where unused
};

/// The points of a mesh that is closed, manifold, oriented, of one component and of genus 0.
/// Triangles with two corners at one place are left out. Otherwise kInvalidInput, with one
/// line that begins with `name` and says what it is instead, how often and where first. O(n).
[[nodiscard]] Result<SphereSurface> as_sphere(const TriangleMesh& mesh, const std::string& name,
                                              int threads = 0);

}  // namespace varifold
