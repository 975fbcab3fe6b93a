// A mesh judged to be a sphere or a disc: what can be laid onto the sphere or half of it.
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
  /// Of a disc the points around it, the surface on their left; empty for a sphere.
  std::vector<std::uint32_t> boundary;

  [[nodiscard]] bool is_disc() const { return !boundary.empty(); }
};

/// The points of a mesh that is manifold, oriented, of one component and either closed and of genus
/// 0 (a sphere), or has one boundary loop and the Euler characteristic 1 (a disc). Triangles with
/// two corners at one place are left out. Otherwise kInvalidInput, with one line that begins with
/// `name` and says what it is instead, how often and where first. O(n log n).
[[nodiscard]] Result<SphereSurface> as_sphere_or_disc(const TriangleMesh& mesh,
                                                      const std::string& name, int threads = 0);

/// The same for spheres alone: a disc is refused as open.
[[nodiscard]] Result<SphereSurface> as_sphere(const TriangleMesh& mesh, const std::string& name,
                                              int threads = 0);

/// The boundary of a disc that is given by its indices and positions, from its lowest point on, the
/// surface on the left; empty where there is none. O(n log n).
[[nodiscard]] std::vector<std::uint32_t> find_boundary(const SphereSurface& surface);

}  // namespace varifold
