// The energy of a surface that is being simplified, and what each collapse would change of it.
//
// Based on: [Hoppe1996] section 4: E = E_dist + E_spring + E_scalar + E_disc.
// Differs: see docs/algorithms/energy.md.
#pragma once

#include <varifold/simplify/collapse_fan.h>
#include <varifold/simplify/curve_samples.h>
#include <varifold/simplify/energy_samples.h>
#include <varifold/simplify/ring_merge.h>
#include <array>
#include <cstdint>
#include <vector>

namespace varifold {

/// Change of the energy, or a part of it; unit scale (squared parts of the diagonal).
struct EnergyChange {
  double surface = 0;  ///< E_dist and E_scalar: samples of the surface
  double spring = 0;   ///< E_spring: lengths of edges
  double curve = 0;    ///< E_disc: samples of discontinuity curves
  [[nodiscard]] double total() const { return surface + spring + curve; }
};

/// What is simplified.
struct EnergyInput {
  WorkingSurface& surface;
  const TriangleMesh& mesh;    ///< that the surface was built from
  AttributeField* attributes;  ///< values of the wedges; null or empty: geometry alone decides
};

/// An evaluated collapse. Where it does not move the vertex that stays, `place` is that of `onto`.
struct EnergyCollapse {
  std::uint32_t from, onto;
  bool moves;
  Vec3 place;
  EnergyChange change;
};

/// Memory that evaluations use again and again; one for each thread.
struct EnergyScratch {
  std::vector<FanFace> fan;
  std::vector<std::uint32_t> faces;  ///< that the collapse changes or removes
  std::vector<std::array<AttributeField::Values, 3>> values;  ///< at the corners of the fan's faces
  FanDistances distances;
  std::vector<std::uint32_t> attributes;  ///< per sample in `distances`: its row of values
  double before = 0;                      ///< energy of those samples as they are attached
  std::uint32_t star = kNone;             ///< the point whose faces and their samples come first
  std::size_t star_samples = 0, star_faces = 0;
  double star_before = 0;
  std::vector<std::uint32_t> neighbors;
  std::vector<EnergyCollapse> starts;
  MergeScratch merge;
};

class SurfaceEnergy {
 public:
  SurfaceEnergy(const EnergyInput& input, const EnergyOptions& options);

  using Collapse = EnergyCollapse;

  /// Says that the next evaluations are of collapses of `from`. O(its samples).
  void look_at(EnergyScratch& scratch, std::uint32_t from) const;

  /// The change by the half-edge collapse; the surface part is a lower bound where the total
  /// exceeds `limit`. With attributes the wedges must have been matched into scratch.merge.
  /// O(samples around from x faces around from).
  [[nodiscard]] Collapse kept(EnergyScratch& scratch, std::uint32_t onto, double limit) const;

  /// The collapse that moves the vertex that stays to the middle of the edge; limits as for kept().
  [[nodiscard]] Collapse middle(EnergyScratch& scratch, std::uint32_t onto, double limit) const;

  /// To the best of the middle and both ends.
  [[nodiscard]] Collapse started(EnergyScratch& scratch, std::uint32_t onto) const;

  /// Lowers the energy of a collapse that moves its vertex: in a few steps, projects the samples
  /// and fits the vertex to them by least squares.
  [[nodiscard]] Collapse fitted(EnergyScratch& scratch, const Collapse& start) const;

  /// Samples to their new faces. To be called just before the rings are merged, with the wedges
  /// matched. Returns the greatest distance of the samples that moved, unit scale.
  float collapse(EnergyScratch& scratch, const Collapse& collapse);

  [[nodiscard]] const SurfaceSamples& samples() const { return samples_; }
  [[nodiscard]] const CurveSamples& curves() const { return curves_; }
  /// The spring constant where so many samples lie on so many faces.
  [[nodiscard]] double spring_constant(std::size_t samples, std::size_t faces) const;
  [[nodiscard]] std::size_t bytes() const { return samples_.bytes() + curves_.bytes(); }

 private:
  void add_samples_of(EnergyScratch& scratch, std::uint32_t face) const;
  void look_at(EnergyScratch& scratch, const FanEdge& edge) const;
  [[nodiscard]] double spring_change(const EnergyScratch& scratch, const FanEdge& edge,
                                     const Vec3& place) const;
  [[nodiscard]] EnergyChange change_at(EnergyScratch& scratch, const FanEdge& edge,
                                       const Vec3& place, double limit) const;
  [[nodiscard]] EnergyChange change_with_nearest(EnergyScratch& scratch, const FanEdge& edge,
                                                 const Vec3& place) const;
  [[nodiscard]] EnergyChange spring_and_curve_change(EnergyScratch& scratch, const FanEdge& edge,
                                                     const Vec3& place) const;
  void gather_values(EnergyScratch& scratch, const FanEdge& edge, const Vec3& place) const;
  [[nodiscard]] float attribute_error(const EnergyScratch& scratch, const Vec3& place,
                                      std::size_t sample) const;
  [[nodiscard]] double nearest_energy(EnergyScratch& scratch, const FanEdge& edge,
                                      const Vec3& place) const;
  [[nodiscard]] Vec3 fit(EnergyScratch& scratch, const FanEdge& edge, const Vec3& place) const;

  WorkingSurface& surface_;
  AttributeField* field_;  // null where it is empty
  EnergyOptions options_;
  SurfaceSamples samples_;
  CurveSamples curves_;
};

}  // namespace varifold
