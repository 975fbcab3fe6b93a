// Which triangles share an edge, whatever their orientation.
#pragma once

#include <varifold/base/large_vector.h>
#include <varifold/partition/surface_view.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// Who is across each edge of a surface. An edge links two half-edges where exactly two triangles
/// have it; they may run in the same direction.
class EdgeLinks {
 public:
  /// O(n) time; 12 B a triangle and 4 B a point while it runs. At most 2^30 - 2 half-edges.
  explicit EdgeLinks(const SurfaceView& surface);

  /// The half-edge on the other side, or kNone at open and at non-manifold edges.
  [[nodiscard]] std::uint32_t across(std::uint32_t half_edge) const {
    return across_[half_edge] == kNone ? kNone : across_[half_edge] & ~kForeign;
  }
  /// As across(), and kNone where the material changes, too.
  [[nodiscard]] std::uint32_t across_in_material(std::uint32_t half_edge) const {
    return across_[half_edge] & kForeign ? kNone : across_[half_edge];
  }
  /// The half-edges of edges with three or more triangles, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& nonmanifold() const { return nonmanifold_; }

 private:
  static constexpr std::uint32_t kForeign = 0x80000000u;

  void match(const SurfaceView& surface);
  void resolve();

  // While matching: the first half-edge of an edge holds the next first one at its lower point and
  // whether it has a partner; the second one names the first.
  LargeVector<std::uint32_t> across_;
  std::vector<std::uint32_t> nonmanifold_;
};

}  // namespace varifold
