// How far apart two surfaces are.
#pragma once

#include <varifold/base/math.h>
#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <memory>

namespace varifold {

struct ClosestPoint {
  DVec3 point{0};
  double distance = 0;             ///< model units; infinity when there is no surface
  std::uint32_t triangle = kNone;  ///< one that holds the point
};

/// A surface that answers how far a point is from it. Immutable and safe to share by threads; it
/// keeps a copy of the triangles, the mesh may go. Distances are exact up to the rounding of
/// doubles: the tree only decides which triangles are looked at, with a margin for its floats.
class SurfaceDistance {
 public:
  /// Builds a tree over the triangles: O(n log n), about 150 bytes a triangle. Positions must be
  /// finite and indices valid.
  explicit SurfaceDistance(const TriangleMesh& mesh);
  ~SurfaceDistance();
  SurfaceDistance(SurfaceDistance&&) noexcept;
  SurfaceDistance& operator=(SurfaceDistance&&) noexcept;

  /// True when there is no triangle.
  [[nodiscard]] bool empty() const;

  /// The point of the surface closest to p (finite). O(log n) as a rule. Of several
  /// triangles at one distance the first is named; the same on every run.
  [[nodiscard]] ClosestPoint closest(const DVec3& p) const;

  /// closest(p).distance
  [[nodiscard]] double distance(const DVec3& p) const { return closest(p).distance; }

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

struct DistanceOptions {
  std::uint32_t samples = 200'000;  ///< points per direction, spread evenly over the area
  std::uint64_t seed = 1;
  bool vertices = false;  ///< look at all vertices of the triangles too, for the maxima alone
  int threads = 0;        ///< 0 = all
};

/// The distance from the points of one surface to another surface.
struct OneSidedDistance {
  double rms = 0;      ///< root mean square over the area, model units
  double maximum = 0;  ///< over the samples: a lower bound of the true maximum
  std::uint32_t samples = 0;
};

/// Both directions; lengths in model units. Two empty meshes are at distance 0; between an empty
/// and another one everything that starts on the other is infinite.
struct SurfaceDistanceReport {
  double rms_a_to_b = 0;
  double rms_b_to_a = 0;
  double rms = 0;  ///< the larger of the two
  double max_a_to_b = 0;
  double max_b_to_a = 0;
  double hausdorff = 0;       ///< the larger of the two; sampled, so a lower bound
  std::uint32_t samples = 0;  ///< per direction
  double diagonal = 0;  ///< of the box around the triangles of b, to put lengths in proportion

  friend bool operator==(const SurfaceDistanceReport&, const SurfaceDistanceReport&) = default;
};

/// Samples `from` by area (by number where it has no area), each sample in its own stratum, and
/// measures to `to`. The same bytes for any number of threads.
/// Based on: [CignoniRocchiniScopigno1998].
[[nodiscard]] OneSidedDistance sampled_distance(const TriangleMesh& from, const SurfaceDistance& to,
                                                const DistanceOptions& options = {});

/// Both directions at once. About 1 s a million samples on one thread.
[[nodiscard]] SurfaceDistanceReport surface_distance(const TriangleMesh& a, const TriangleMesh& b,
                                                     const DistanceOptions& options = {});

}  // namespace varifold
