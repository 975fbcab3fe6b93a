// Who touches whom on the surface. All topology is judged on position classes (weld.h), so that a
// seam of the attributes is no boundary.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/mesh/weld.h>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace varifold {

/// The triangles around every position class, in compressed rows.
class VertexFaces {
 public:
  /// `indices` are those of the mesh (three a triangle, each below weld.class_of.size()). O(n).
  VertexFaces(std::span<const std::uint32_t> indices, const WeldMap& weld);

  /// The triangles with a corner in the class, ascending; a degenerate one stands there once.
  [[nodiscard]] std::span<const std::uint32_t> triangles_of(std::uint32_t position_class) const {
    return {triangles_.data() + offsets_[position_class],
            triangles_.data() + offsets_[position_class + 1]};
  }
  [[nodiscard]] std::uint32_t class_count() const {
    return static_cast<std::uint32_t>(offsets_.size() - 1);
  }

 private:
  std::vector<std::uint32_t> offsets_;
  std::vector<std::uint32_t> triangles_;
};

/// What kind of surface a mesh is. A triangle is degenerate when two of its corners are of one
/// position class; degenerate triangles count nowhere but in `degenerate_triangles`.
struct TopologyReport {
  std::uint32_t vertices = 0;      ///< entries of the vertex buffer
  std::uint32_t classes = 0;       ///< different positions
  std::uint32_t used_classes = 0;  ///< those that a triangle uses
  std::uint32_t triangles = 0;     ///< without the degenerate ones
  std::uint32_t degenerate_triangles = 0;
  std::uint32_t duplicate_triangles = 0;   ///< on the same three classes as another one before
  std::uint64_t edges = 0;                 ///< pairs of classes that a triangle joins
  std::uint64_t boundary_edges = 0;        ///< with one triangle
  std::uint64_t nonmanifold_edges = 0;     ///< with three or more
  std::uint64_t misoriented_edges = 0;     ///< with two that run along it in the same direction
  std::uint32_t nonmanifold_vertices = 0;  ///< used classes whose link is not one path or cycle;
                                           ///< so both ends of every non-manifold edge
  std::uint32_t components = 0;            ///< connected by common position classes
  /// Loops of boundary edges, followed along the triangles: as if every vertex where several fans
  /// touch were split into one per fan. A chain that ends at a non-manifold edge counts as well.
  std::uint32_t boundary_loops = 0;
  std::int64_t euler_characteristic = 0;  ///< used classes - edges + triangles
  bool closed = false;  ///< there is a triangle and every edge has an even number of them

  [[nodiscard]] bool manifold() const {
    return nonmanifold_edges == 0 && nonmanifold_vertices == 0;
  }
  [[nodiscard]] bool oriented() const { return misoriented_edges == 0; }
  /// Handles of all components together, where the surface is closed, manifold and oriented.
  [[nodiscard]] std::optional<std::int64_t> genus() const {
    if (!closed || !manifold() || !oriented()) return std::nullopt;
    return components - euler_characteristic / 2;
  }
};

/// Judges the topology on position classes. Indices must be valid. O(n log valence), in parallel
/// (0 threads = all); the result does not depend on the number of threads.
[[nodiscard]] TopologyReport analyze_topology(const TriangleMesh& mesh, const WeldMap& weld,
                                              int threads = 0);

}  // namespace varifold
