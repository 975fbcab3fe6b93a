// Moves single vertices of a map onto the sphere so that it distorts the surface less, without
// ever folding it.
#pragma once

#include <varifold/base/math.h>
#include <varifold/morph/ring_mesh.h>
#include <varifold/morph/sphere_point.h>
#include <varifold/morph/surface_lift.h>
#include <limits>
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

  /// From now on distortion is that of the map from this surface to the one of `lift`, by way of
  /// the sphere. `lift` must outlive this; null: onto the sphere again.
  void set_lift(const SurfaceLift* lift);

  /// Edges count as if they were at least about this long, in the unit of the positions.
  void set_length_floor(double length) { floor_ = length * length; }

  /// The area of the surface over that of the sphere.
  void set_scale(double scale) { scale_ = scale; }

  /// Puts a vertex, of which only the ring has places, where it sees the whole ring: ring[0] does
  /// so without it. False where the resolution of the sphere does not suffice.
  [[nodiscard]] bool place(std::uint32_t vertex);

  /// Where a vertex is tried.
  enum class Reach : std::uint8_t {
    kNear,
    kStar  ///< first at places all over its star; eight times as slow
  };

  /// Moves a vertex to where its star is distorted less, `rounds` times at most. The distance that
  /// it moved, in radians. Never folds.
  double relax(std::uint32_t vertex, int rounds, Reach reaching = Reach::kNear);

  /// Moves a vertex towards a place, as far as its star allows: all of the way, or half of what is
  /// possible, so that there is room left for others to give way.
  void drag(std::uint32_t vertex, const SpherePoint& goal);

  /// With a lift: the mean over the triangles, by the sum of both areas, of the base-two logarithm
  /// of (r + 1/r) (g + 1/g) / 4, at most 20 for each. 0 for similar surfaces.
  [[nodiscard]] double mean_distortion();

  /// Per vertex, with a lift, its place on that surface; as of the last moves.
  [[nodiscard]] std::span<const DVec3> lifted() const { return lifted_; }

 private:
  struct Corner {
    DVec3 place;        ///< of a neighbour, on the sphere
    DVec3 lifted;       ///< the same on the surface that distortion is measured on
    double uu, uv, vv;  ///< the metric of the surface in the triangle that begins there
    double area;        ///< of it on the surface
  };
  void gather(std::uint32_t vertex);
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  struct Trial {
    DVec3 point{0}, lifted{0};
    std::uint32_t hint = 0;
    double distortion = 0;
  };
  [[nodiscard]] double nearest_corner(const DVec3& point) const;
  void try_star(Trial& best) const;
  [[nodiscard]] Trial trial_at(const DVec3& point, std::uint32_t hint,
                               double most = kNoLimit) const;
  [[nodiscard]] double distortion_at(const DVec3& point, const DVec3& lifted,
                                     double most = kNoLimit) const;
  [[nodiscard]] bool is_positive(const DVec3& u, const DVec3& v, const DVec3& point) const;
  void move_to(std::uint32_t vertex, const SpherePoint& point);
  bool accept(std::uint32_t vertex, const DVec3& point);
  [[nodiscard]] bool place_in_kernel(std::uint32_t vertex);
  [[nodiscard]] bool place_near_target(std::uint32_t vertex);

  const RingMesh& mesh_;
  std::span<const Vec3> positions_;
  std::span<SpherePoint> points_;
  const SurfaceLift* lift_ = nullptr;
  std::vector<DVec3> lifted_;  // per vertex, with a lift
  std::vector<std::uint32_t> hints_;
  double floor_ = 0;
  double scale_ = 1;
  std::vector<Corner> corners_;
  std::vector<glm::dvec2> kernel_, clipped_;
};

}  // namespace varifold
