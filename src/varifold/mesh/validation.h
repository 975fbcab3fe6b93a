// Proves a mesh sound, or lists what is not.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <string>
#include <vector>

namespace varifold {

enum class Severity {
  kBroken,  ///< the mesh cannot be used: no function but validate() may be called with it
  kFault,   ///< a defect of the surface; a mesh with one is not sound
  kNote,    ///< legal, but worth knowing
};

/// One kind of thing that a mesh has.
struct Fault {
  std::string kind;         ///< a stable snake_case name, see validate()
  std::uint64_t count = 0;  ///< how often, at least 1
  std::string where;        ///< the first places, e.g. "triangle 12, 77, 90, ..."
  Severity severity = Severity::kFault;
};

/// Lists the faults of a mesh, the most severe first; empty for a closed manifold without any.
/// Accepts every mesh. Topology is judged on position classes. O(n log valence), in parallel
/// (0 threads = all); the result does not depend on the number of threads.
///
/// - broken: wrong_array_size, incomplete_triangle, index_out_of_range, bad_material_range,
///   bad_texture_index, nonfinite_position. When there is one, nothing below is looked for.
/// - faults: degenerate_triangle (two corners at one position), duplicate_triangle,
///   nonmanifold_edge, misoriented_edge, nonmanifold_vertex, nonfinite_normal, zero_normal,
///   nonfinite_texcoord.
/// - notes: boundary_edge, unused_vertex, zero_area_triangle (corners apart, on one line),
///   unnormalized_normal (length off by more than 1 %).
/// Edges and vertices are named by the first vertex at their position.
[[nodiscard]] std::vector<Fault> validate(const TriangleMesh& mesh, int threads = 0);

/// True when no fault is broken or a fault; notes do not count.
[[nodiscard]] bool is_sound(const std::vector<Fault>& faults);

/// The triangles of a simplified mesh that face the wrong way, ascending.
///
/// A triangle is flipped when its normal opposes (dot product < 0) the normals of ALL triangles of
/// `reference` around the positions of its three corners. Corners are found by equal positions, so
/// this judges meshes whose vertices were vertices of the reference (half-edge collapses); a
/// triangle with a corner that is not there is not judged. Nor are triangles without area, on
/// either side. Being all-or-nothing it never accuses a triangle
/// that spans a crease or a curved region; a folded triangle whose corners lie on creases may
/// escape. Indices must be valid. O(n), in parallel.
[[nodiscard]] std::vector<std::uint32_t> flipped_triangles(const TriangleMesh& mesh,
                                                           const TriangleMesh& reference,
                                                           int threads = 0);

/// How many they are.
[[nodiscard]] std::uint64_t count_flipped(const TriangleMesh& mesh, const TriangleMesh& reference);

}  // namespace varifold
