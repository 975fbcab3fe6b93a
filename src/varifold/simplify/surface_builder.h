// Building the surface from a mesh, in steps: numbers first, then what lies around each point.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/simplify/working_surface.h>
#include <atomic>
#include <cstdint>
#include <vector>

namespace varifold {

/// build_surface() in steps, for those who have something to do in between.
class SurfaceBuilder {
 public:
  /// Numbers points and faces. The mesh outlives this. O(n log n).
  SurfaceBuilder(const TriangleMesh& mesh, const SurfaceOptions& options);

  /// Positions, and which vertices and triangles they belong to; the rest comes later.
  [[nodiscard]] const WorkingSurface& surface() const { return surface_; }
  /// Rings and normals; others may read surface() meanwhile. O(n).
  void make_rings();
  /// Leaves repeated triangles out, then wedges and kinds. O(n).
  [[nodiscard]] WorkingSurface finish(InputFaults& faults);

 private:
  friend void rebuild_rings(WorkingSurface& surface, std::span<const std::uint32_t> faces,
                            std::span<const std::uint32_t> corners);
  SurfaceBuilder(const TriangleMesh& mesh, const SurfaceOptions& options, WorkingSurface&& surface)
      : mesh_(mesh), options_(options), surface_(std::move(surface)) {}

  [[nodiscard]] bool is_degenerate(std::uint32_t face) const {
    const std::uint32_t* p = &face_points_[3 * std::size_t{face}];
    return p[0] == p[1] || p[1] == p[2] || p[2] == p[0];
  }
  void make_points();
  void make_faces();
  void fill_rings();
  void make_room();
  void add_to_rings(std::uint32_t face);
  void order_rings(std::uint32_t begin, std::uint32_t end, bool with_normals);
  void set_normal(std::uint32_t point);
  void order_one(std::uint32_t point, std::vector<LinkEdge>& edges, std::vector<RingEntry>& ring);
  void count_faces();

  const TriangleMesh& mesh_;
  SurfaceOptions options_;
  WorkingSurface surface_;
  InputFaults faults_;
  std::vector<std::uint32_t> face_points_;  // three per input triangle
  std::vector<std::uint32_t> degree_;
  std::atomic<bool> any_dropped_{false};
};

}  // namespace varifold
