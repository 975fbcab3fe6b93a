// A cut through a model for a view, as pieces of triangles: what is drawn of it, and how far it is
// from the original.
#pragma once

#include <varifold/base/math.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/camera.h>
#include <varifold/view/criteria.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold::bench {

/// Triangles that are drawn or culled together; one after the other in the mesh of the cut.
struct CutPiece {
  std::uint32_t first_triangle = 0, triangle_count = 0;
  std::uint32_t submitted = 0;  ///< triangles that the device is given, collapsed ones among them
};

struct Cut {
  TriangleMesh mesh;
  std::vector<CutPiece> pieces;
};

/// What a renderer leaves out before it draws.
enum class Culling {
  kFrustum,           ///< pieces outside the frustum
  kFrustumAndTurned,  ///< and those that are turned away as a whole
};

/// Triangles submitted for the pieces that are left, judged by ball and cone of what each draws.
/// O(triangles).
[[nodiscard]] std::uint64_t drawn_triangles(const Cut& cut, const ViewCriterion& view,
                                            Culling culling);
/// Triangles that reach into the frustum, one by one, whatever piece they are in; collapsed ones
/// are not counted. O(triangles).
[[nodiscard]] std::uint64_t triangles_inside(const Cut& cut, const ViewCriterion& view);
/// All that is submitted where nothing is culled.
[[nodiscard]] std::uint64_t submitted_triangles(const Cut& cut);

/// Pixels that the distance from each point to the cut covers at the point, across the ray.
[[nodiscard]] std::vector<double> pixels_off(std::span<const DVec3> points, const Cut& cut,
                                             const PixelScale& scale);

/// Whether the edges where one surface ends are those where the other does, each as often and in
/// the same direction; vertices are the same where their positions are. For closed surfaces:
/// whether `cut` is closed, too. O(n log n).
[[nodiscard]] bool has_same_border(const TriangleMesh& cut, const TriangleMesh& original);

}  // namespace varifold::bench
