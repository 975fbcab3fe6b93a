// Who touches whom on the surface. All topology is judged on position classes (weld.h), so that a
// seam of the attributes is no boundary.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/mesh/weld.h>
#include <cstdint>
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

}  // namespace varifold
