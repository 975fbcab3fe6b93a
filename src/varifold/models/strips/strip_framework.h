// The strips framework: triangle strips that never change but in the vertices they name, at any
// uniform or variable level of detail.
//
// Based on: [Ramos2008] chapter 3.
// Differs: the records of a collapse are a range of one list of strip positions, sorted so that the
//   ranges of all collapses nest, instead of a list each; refining undoes collapses in the exact
//   reverse order; variable resolution obeys a dependency rule, without which it folds the mesh.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/common/error_code.h>
#include <varifold/models/common/level_queries.h>
#include <varifold/models/common/level_table.h>
#include <varifold/models/strips/nested_ranges.h>
#include <varifold/strip/triangle_strips.h>
#include <varifold/view/cone_code.h>
#include <varifold/view/criteria.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// The parts of a framework beside its strips, plain data.
struct StripFrameworkData {
  /// Vertex attributes at full detail, materials and images; the material ranges of full detail.
  TriangleMesh mesh;
  LevelTable levels;
  /// For the steps from the finest to the coarsest: the finer steps whose collapses must be done
  /// before the step's own, ascending, the last one with kLastDependency; kNone where none must.
  std::vector<std::uint32_t> dependencies;
  // Per step, what RegionBounds says of it; the ball is about the first vertex of the step.
  std::vector<float> radius;
  std::vector<std::uint32_t> cone;         ///< cone_code.h
  std::vector<std::uint16_t> error_codes;  ///< error_code.h
  std::vector<std::uint32_t> slivers;      ///< strip_levels.h

  static constexpr std::uint32_t kLastDependency = 0x80000000u;
};

/// Immutable, shared by any number of instances and threads. A slot is a place in the strips, all
/// of them one after the other.
class StripFramework : public LevelQueries<StripFramework> {
 public:
  StripFramework() = default;
  /// `strips` are those of full detail; strips of a material range must follow those of the ranges
  /// before. Everything must be consistent, as from build_strip_framework() or
  /// decode_strip_framework(). O(n).
  StripFramework(StripFrameworkData data, TriangleStrips strips);

  [[nodiscard]] const StripFrameworkData& data() const { return data_; }
  [[nodiscard]] const LevelTable& levels() const { return data_.levels; }
  [[nodiscard]] const TriangleMesh& attributes() const { return data_.mesh; }

  [[nodiscard]] std::uint32_t strip_count() const {
    return static_cast<std::uint32_t>(strip_range_.size());
  }
  [[nodiscard]] std::uint32_t slot_count() const { return first_slot_.back(); }
  /// Per strip its first slot, and the end of the last one; and its range of `mesh.ranges`.
  [[nodiscard]] std::span<const std::uint32_t> first_slots() const { return first_slot_; }
  [[nodiscard]] std::span<const std::uint32_t> strip_ranges() const { return strip_range_; }
  /// Those of `data().slivers` that are in a strip. O(log slivers).
  [[nodiscard]] std::span<const std::uint32_t> slivers_of(std::uint32_t strip) const;
  /// The strips at full detail. O(slots).
  [[nodiscard]] TriangleStrips full_strips() const;

  /// The records of a vertex: the slots that its collapse changes from it to its target, and its
  /// split back. They are those that name it or a vertex below it in the tree of targets at full
  /// detail.
  [[nodiscard]] std::span<const std::uint32_t> records(std::uint32_t vertex) const {
    return {slots_.data() + records_[vertex].begin, records_[vertex].count};
  }
  /// Of all collapses together. O(vertices).
  [[nodiscard]] std::uint64_t record_count() const;
  /// What is known of the surface that a step changes; `vertex` is the step's first one.
  [[nodiscard]] RegionBounds region(std::uint32_t step, std::uint32_t vertex) const {
    return {ball(step, vertex), cone(step), step_error(step)};
  }
  /// Its parts; the normals take the longest.
  [[nodiscard]] Sphere ball(std::uint32_t step, std::uint32_t vertex) const {
    return {data_.mesh.positions[vertex], data_.radius[step]};
  }
  [[nodiscard]] NormalCone cone(std::uint32_t step) const { return unpack_cone(data_.cone[step]); }
  [[nodiscard]] float step_error(std::uint32_t step) const {
    return error_of_code(data_.error_codes[step]);
  }

  /// Memory of all arrays but images; vertices included.
  [[nodiscard]] std::size_t bytes() const;

 private:
  StripFrameworkData data_;
  std::vector<std::uint32_t> first_slot_{0};
  std::vector<std::uint32_t> strip_range_;
  std::vector<std::uint32_t> slots_;  // of all vertices, in nested ranges along the tree of targets
  std::vector<NestedRange> records_;  // per vertex
};

}  // namespace varifold
