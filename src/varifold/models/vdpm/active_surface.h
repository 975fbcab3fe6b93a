// The surface of a front: single steps done and undone in draw-ready buffers.
#pragma once

#include <varifold/models/vdpm/active_vertices.h>
#include <varifold/models/vdpm/draw_triangles.h>
#include <varifold/models/vdpm/view_dependent_mesh.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <cstdint>

namespace varifold {

/// Begins with the base. Its functions trust the caller to keep the rule: a step is split after all
/// that it requires, and collapsed after all that require it. What is shown depends on the steps
/// that are split alone, where it stands in the buffers on the way to them. Nothing is allocated
/// once the buffers have had the size; reserve() gives it at once.
class ActiveSurface {
 public:
  /// `model` must live as long. O(size of the model).
  explicit ActiveSurface(const ViewDependentMesh& model);

  [[nodiscard]] std::uint32_t vertex_count() const { return vertices_.count(); }
  [[nodiscard]] std::uint32_t triangle_count() const { return triangles_.count(); }
  [[nodiscard]] bool is_split(std::uint32_t step) const {
    return vertices_.is_active(model_->first_vertex(step));
  }

  /// O(triangles around the step's point).
  void split(std::uint32_t step);
  void collapse(std::uint32_t step);
  /// The same, but the vertices that stay keep their attributes where placement moves them: for
  /// whoever moves them otherwise.
  void split_connectivity(std::uint32_t step);
  void collapse_connectivity(std::uint32_t step);
  [[nodiscard]] ActiveVertices& vertices_to_move() { return vertices_; }
  /// Room for so many.
  void reserve(std::uint32_t vertices, std::uint32_t triangles);

  [[nodiscard]] const ActiveVertices& vertices() const { return vertices_; }
  [[nodiscard]] const DrawTriangles& triangles() const { return triangles_; }

  /// Indices name slots. What changed since the last call; valid until the surface changes.
  [[nodiscard]] DrawList draw_list();
  /// As a mesh with the active vertices and triangles in the order of their numbers in the model,
  /// materials and images included. O(size of the model).
  [[nodiscard]] TriangleMesh extract() const;
  [[nodiscard]] std::size_t bytes() const { return vertices_.bytes() + triangles_.bytes(); }

 private:
  void add_vertex(std::uint32_t vertex);
  void write_finer(std::uint32_t step);
  void write_coarser(std::uint32_t step);

  const ViewDependentMesh* model_;
  ActiveVertices vertices_;
  DrawTriangles triangles_;
};

}  // namespace varifold
