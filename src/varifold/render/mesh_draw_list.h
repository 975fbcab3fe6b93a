// A mesh as something to draw.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/draw_list.h>
#include <vector>

namespace varifold {

/// The draw list of a mesh that does not change: one range per material range. The mesh
/// must outlive the object and stay as it is; O(ranges + materials).
class MeshDrawList {
 public:
  explicit MeshDrawList(const TriangleMesh& mesh);
  /// Valid while the object lives.
  [[nodiscard]] DrawList list() const;
  /// Base colours by material, for DrawStyle::material_colors; valid while the object lives.
  [[nodiscard]] std::span<const Vec4> material_colors() const { return material_colors_; }

 private:
  const TriangleMesh* mesh_;
  std::vector<DrawRange> ranges_;
  std::vector<Vec4> material_colors_;
};

}  // namespace varifold
