// Moves single vertices of a map onto the sphere so that it distorts the surface less, without
// ever folding it.
#pragma once

#include <varifold/base/math.h>
#include <varifold/morph/ring_mesh.h>
#include <varifold/morph/sphere_point.h>
#include <span>
#include <vector>

namespace varifold {

/// True when every triangle of the star is positive with the vertex at `point`.
///
/// For a star that was an embedded fan before, it is one after: all places that see the whole ring
/// make a convex region, so the vertex could have gone there without a fold on its way.
[[nodiscard]] bool is_star_positive(std::span<const SpherePoint> points,
                                    std::span<const std::uint32_t> ring, const SpherePoint& point);

/// The map of a surface (positions) onto the sphere (points), vertex by vertex.
///
/// Based on: [DegenerMesethKlein2003] for the energy, angles times areas with equal weight;
///   [PraunHoppe2003] section 3 for moving vertices on the sphere by line searches.
/// Differs: two perpendicular directions with a parabola each. Lengths have a floor, so that
///   needles of the surface get some of the sphere, too. The L2 stretch of the second paper keeps
///   areas but not angles: on legs and ears triangles are drawn out twenty times, and the overlay
///   of a horse and an armadillo has three times the crossings.
class StarRelaxation {
 public:
  /// All spans must outlive this; `points` is what is moved.
  StarRelaxation(const RingMesh& mesh, std::span<const Vec3> positions,
                 std::span<SpherePoint> points);

  /// Edges count as if they were at least about this long, in the unit of the positions.
  void set_length_floor(double length) { floor_ = length * length; }

  /// The area of the surface over that of the sphere.
  void set_scale(double scale) { scale_ = scale; }

  /// Puts a vertex, of which only the ring has places, where it sees the whole ring: ring[0] does
  /// so without it. False where the resolution of the sphere does not suffice.
  [[nodiscard]] bool place(std::uint32_t vertex);

  /// Moves a vertex to where its star is distorted less, `rounds` times at most. The distance that
  /// it moved, in radians. Never folds.
  double relax(std::uint32_t vertex, int rounds);

 private:
  struct Corner {
    DVec3 place;        ///< of a neighbour
    double uu, uv, vv;  ///< the metric of the surface in the triangle that begins there
    double area;        ///< of it on the surface
  };
  void gather(std::uint32_t vertex);
  [[nodiscard]] double distortion_at(const DVec3& point) const;
  [[nodiscard]] bool accept(std::uint32_t vertex, const DVec3& point);
  [[nodiscard]] bool place_in_kernel(std::uint32_t vertex);
  [[nodiscard]] bool place_near_target(std::uint32_t vertex);

  const RingMesh& mesh_;
  std::span<const Vec3> positions_;
  std::span<SpherePoint> points_;
  double floor_ = 0;
  double scale_ = 1;
  std::vector<Corner> corners_;
  std::vector<glm::dvec2> kernel_, clipped_;
};

}  // namespace varifold
