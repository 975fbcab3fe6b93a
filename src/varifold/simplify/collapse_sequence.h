// CollapseSequence: the one currency of detail. PM, VDPM, LodStrips and MTS are built from it.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// An ordered list of collapses, read backwards: level 0 is the base mesh, each step adds detail,
/// level step_count() is the full mesh.
///
/// It speaks of a mesh whose vertices and triangles are numbered by it: level k uses the vertices
/// [0, vertices[k]) and, of every material range, the first triangles. Going from level k + 1 to k
/// moves the vertices [vertices[k], vertices[k + 1]) - all wedges of one position class - onto
/// their targets, wedges of one neighbouring class, and removes the triangles that collapse.
struct CollapseSequence {
  /// Per vertex, where it goes when it vanishes: target[v] < v; kNone for vertices of the base.
  std::vector<std::uint32_t> target;
  /// Per triangle, the coarsest level that has it; ascending within each material range.
  std::vector<std::uint32_t> triangle_level;
  std::vector<std::uint32_t> vertices;   ///< per level, ascending; size step_count() + 1
  std::vector<std::uint32_t> triangles;  ///< per level, in all ranges together
  /// Per level, a distance in model units, never rising with the level, 0 at the full level. What
  /// it bounds is said by `error_is_measured`:
  ///  true: no vertex of the full mesh is farther than this from the surface of the level, nor
  ///        from that of any finer level (deviation.h), in any blend of its shapes;
  ///  false: an estimate, the running maximum of the root mean square distance to the planes that
  ///        the quadric of the surviving vertex has gathered.
  std::vector<float> error;
  bool error_is_measured = false;

  /// With optimal placement, a collapse also moves the vertices that stay: the collapse to level k
  /// sets placed_vertex[j] to the attributes j of `placed`, for j in [first_placed[k],
  /// first_placed[k + 1]). Empty with kept vertices.
  std::vector<std::uint32_t> first_placed;
  std::vector<std::uint32_t> placed_vertex;
  TriangleMesh placed;  ///< vertex attributes only

  [[nodiscard]] std::uint32_t step_count() const {
    return vertices.empty() ? 0 : static_cast<std::uint32_t>(vertices.size() - 1);
  }
  [[nodiscard]] bool moves_vertices() const { return !first_placed.empty(); }

  /// The vertex that stands for `vertex` at `level`: itself while it exists. O(depth).
  [[nodiscard]] std::uint32_t ancestor(std::uint32_t vertex, std::uint32_t level) const {
    while (vertex >= vertices[level]) vertex = target[vertex];
    return vertex;
  }

  /// ancestor() of every vertex of the full mesh at once. O(vertices).
  [[nodiscard]] std::vector<std::uint32_t> ancestors(std::uint32_t level) const;

  /// The finest level with at most so many triangles, vertices; level 0 where none has so few.
  /// O(log steps).
  [[nodiscard]] std::uint32_t level_for_triangles(std::uint32_t count) const;
  [[nodiscard]] std::uint32_t level_for_vertices(std::uint32_t count) const;
  /// The coarsest level whose error is at most `bound`. O(log steps).
  [[nodiscard]] std::uint32_t level_for_error(float bound) const;
};

/// A mesh numbered by its sequence.
struct DetailedMesh {
  TriangleMesh mesh;  ///< the full level
  CollapseSequence sequence;
  std::vector<std::uint32_t> original_vertex;    ///< per vertex, the vertex of the input
  std::vector<std::uint32_t> original_triangle;  ///< per triangle, the triangle of the input
  /// Shapes that the mesh takes beside its own and its poses: what a skin does, for example. What
  /// is said to hold in all blends does so in those of these, too. Places only.
  std::vector<Pose> samples;

  /// The places of all vertices at rest, in the poses, and in the samples.
  [[nodiscard]] std::vector<std::span<const Vec3>> shapes() const;
  [[nodiscard]] bool has_shapes() const { return !mesh.poses.empty() || !samples.empty(); }
};

/// The mesh at a level, by its definition: every vertex replaced by its ancestor. The reference
/// for all models; O(mesh), whatever the level. Vertices keep their numbers.
[[nodiscard]] TriangleMesh mesh_at_level(const DetailedMesh& detailed, std::uint32_t level);

/// Makes that level the base. O(vertices + triangles).
void cut_below(std::uint32_t level, CollapseSequence& sequence);

/// The attributes of the vertices [0, vertices[level]) at a level, where placement moves them.
/// O(vertices + steps above the level).
void apply_placement(const CollapseSequence& sequence, std::uint32_t level, TriangleMesh& mesh);

}  // namespace varifold
