// The view-dependent mesh: a hierarchy of vertex splits, each of which may be done on its own as
// soon as those that it requires are.
//
// Based on: [Hoppe1997] section 3.
// Differs: a split requires the splits that made the triangles around its point what they are in
//   the sequence (docs/algorithms/strip_framework.md), not four neighbouring faces: so what it
//   changes is a constant list, and a front has no triangle that no level has. Seams, materials
//   and non-manifold meshes are steps like others.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/common/level_queries.h>
#include <varifold/models/common/level_table.h>
#include <varifold/models/vdpm/step_bounds.h>
#include <varifold/models/vdpm/step_records.h>
#include <varifold/view/sphere.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// The parts of the model, plain data.
struct ViewDependentMeshData {
  TriangleMesh mesh;  ///< vertex attributes at full detail, materials, images, ranges
  LevelTable levels;
  std::vector<PackedBounds> bounds;  ///< per step
  /// Per step, of both balls, where the mesh takes several shapes; else they follow from positions.
  std::vector<Vec3> centers;
  StepRecords records;  ///< per step
  std::vector<std::uint32_t> watch_roots;
  std::vector<std::uint32_t> base_corners;    ///< three for each triangle of the base
  std::vector<std::uint32_t> base_triangles;  ///< their numbers, ascending
  /// With optimal placement: the collapse of step k sets vertex placed_vertex[j] to the attributes
  /// j of `placed`, for j in [first_placed[k], first_placed[k + 1]); its split sets it to the
  /// attributes finer[j], or, for kNone, to those at full detail. A vertex appears with the
  /// attributes first_look[v], or kNone.
  std::vector<std::uint32_t> first_placed, placed_vertex, finer, first_look;
  TriangleMesh placed;
};

/// Immutable, shared by any number of instances and threads. Step k leads from level k to k + 1.
class ViewDependentMesh : public LevelQueries<ViewDependentMesh> {
 public:
  ViewDependentMesh() = default;
  /// Everything must be consistent, as from build_view_dependent_mesh().
  explicit ViewDependentMesh(ViewDependentMeshData data);

  [[nodiscard]] const ViewDependentMeshData& data() const { return data_; }
  [[nodiscard]] const LevelTable& levels() const { return data_.levels; }
  /// At full detail, also where placement moves vertices.
  [[nodiscard]] const TriangleMesh& attributes() const { return data_.mesh; }
  [[nodiscard]] std::uint32_t step_count() const { return data_.levels.finest_level(); }
  [[nodiscard]] bool moves_vertices() const { return !data_.first_placed.empty(); }

  /// The step's first vertex; those of the step have the numbers from there on, up to that of the
  /// next. `step` is at most step_count(). O(1).
  [[nodiscard]] std::uint32_t first_vertex(std::uint32_t step) const {
    return one_vertex_a_step_ ? step + base_vertices_ : data_.levels.vertex_count(step);
  }
  [[nodiscard]] StepBounds bounds(std::uint32_t step) const {
    const PackedBounds& b = data_.bounds[step];
    return {first_vertex(step), b.cone,        b.radius, b.nested_radius, b.mu, b.delta,
            b.nested_error,     b.nested_angle};
  }
  [[nodiscard]] const PackedBounds& packed_bounds(std::uint32_t step) const {
    return data_.bounds[step];
  }
  /// Of both balls: where the split puts the step's point; the middle of all places where that is,
  /// where the mesh takes several shapes.
  [[nodiscard]] const Vec3& center(std::uint32_t step) const {
    return has_plain_centers_ ? data_.mesh.positions[step + base_vertices_] : other_center(step);
  }
  /// Holds every vertex of every front. O(1).
  [[nodiscard]] const Sphere& bounding_ball() const { return ball_; }

  /// Hints that the bounds, or the record, of a step are wanted soon.
  void prefetch_bounds(std::uint32_t step) const {
    __builtin_prefetch(&data_.bounds[step]);
    __builtin_prefetch(&center(step));
  }
  void prefetch_record(std::uint32_t step) const { data_.records.prefetch(step); }

  /// f(coarser step): those that must be split before this one, ascending; nearly always without
  /// those that follow from others.
  template <class F>
  void for_each_required(std::uint32_t step, const F& f) const {
    data_.records.for_each_required(data_.records.find(step), f);
  }
  /// f(finer step): the children of the step in the watch tree; the parent of a step is the finest
  /// that it requires.
  template <class F>
  void for_each_watched(std::uint32_t step, const F& f) const {
    data_.records.for_each_watched(data_.records.find(step), f);
  }
  /// The steps that require none.
  [[nodiscard]] std::span<const std::uint32_t> watch_roots() const { return data_.watch_roots; }

  /// f(triangle, corner, vertex of the step): corners that the split takes from the vertex's target
  /// to the vertex.
  template <class F>
  void for_each_changed(std::uint32_t step, const F& f) const {
    data_.records.for_each_changed(data_.records.find(step), first_vertex(step), f);
  }
  /// f(triangle, corners): the triangles that the split adds, with their corners then.
  template <class F>
  void for_each_added(std::uint32_t step, const F& f) const {
    const std::uint32_t vertex = first_vertex(step);
    data_.records.for_each_added(data_.records.find(step), vertex, data_.levels.target(vertex),
                                 data_.levels.triangle_count(step), f);
  }

  /// The place in `attributes().ranges` of a triangle; 0 where there are none. O(log ranges).
  [[nodiscard]] std::uint32_t range_of(std::uint32_t triangle) const {
    const auto& ranges = data_.mesh.ranges;
    if (ranges.size() < 2) return 0;
    const auto after = std::upper_bound(
        ranges.begin(), ranges.end(), triangle,
        [](std::uint32_t t, const MaterialRange& range) { return t < range.first_triangle; });
    return static_cast<std::uint32_t>(after - ranges.begin() - 1);
  }

  /// Memory of all arrays but images; vertices included.
  [[nodiscard]] std::size_t bytes() const;

 private:
  [[nodiscard]] const Vec3& other_center(std::uint32_t step) const;

  ViewDependentMeshData data_;
  Sphere ball_;
  std::uint32_t base_vertices_ = 0;
  bool one_vertex_a_step_ = false;
  bool has_plain_centers_ = false;  // the positions beyond the base, one a step
};

}  // namespace varifold
