// Two closed surfaces of genus 0 laid onto one sphere together, so that they distort each other
// little.
//
// Both are made coarse, laid onto the sphere as they are then, and grow in steps. At every size
// each surface in turn is moved against the other one, by the distortion of the map from the one to
// the other by way of the sphere. Coarse surfaces have their limbs still, and few enough vertices
// that these find each other.
//
// Based on: [SchreinerAsirvathamPraunHoppe2004], coarse to fine by the distortion between both.
// Differs: both have maps onto the sphere instead of a mesh that both are cut into, so that all
//   signs are exact; the sides take turns; a vertex is tried all over its star.
#pragma once

#include <varifold/base/result.h>
#include <varifold/morph/alignment.h>
#include <varifold/morph/ring_decimation.h>
#include <varifold/morph/star_relaxation.h>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace varifold {

/// A closed surface: triangles over vertices that are all used.
struct SurfaceView {
  std::span<const std::uint32_t> indices;
  std::span<const Vec3> positions;
};

/// A surface of its own.
struct CoarseSurface {
  std::vector<std::uint32_t> indices;
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> vertices;  ///< what each vertex was

  [[nodiscard]] SurfaceView view() const { return {indices, positions}; }
};

/// Two places that meet on the sphere, one on each surface.
struct Meeting {
  DVec3 on_a, on_b;
  double weight = 0;  ///< an area
};

class PairGrowth {
 public:
  static constexpr std::uint32_t kAll = 0xffffffffu;

  /// What the views show must outlive this.
  explicit PairGrowth(const std::array<SurfaceView, 2>& surfaces);
  ~PairGrowth();

  /// Takes vertices off side `s`.
  void coarsen(int s, const DecimationOptions& options);
  [[nodiscard]] CoarseSurface coarse(int s) const;

  /// Keeps a vertex where it is put.
  void hold(int s, std::uint32_t vertex);
  /// A direction for a vertex of side `s`.
  void put(int s, std::uint32_t vertex, const SpherePoint& point);
  /// Whether all triangles that are left are positive.
  [[nodiscard]] bool is_positive() const;

  /// Gives back what was taken off, up to about `most` vertices a side; both sides are moved all
  /// the while. Features are dragged together, and stay so, once both sides have 200 vertices.
  /// False where a vertex finds no place on the sphere, and when cancelled. O(n log n), one thread.
  [[nodiscard]] bool grow(std::span<const FeaturePoint> features, std::uint32_t most = kAll,
                          const std::function<bool(float done)>& progress = {});

  /// Mean over both, in bits; see StarRelaxation. 0 for similar surfaces.
  [[nodiscard]] double distortion();
  /// One for every vertex that is there.
  [[nodiscard]] std::vector<Meeting> meetings();
  [[nodiscard]] std::span<const SpherePoint> points(int s) const;

 private:
  struct Side;
  void see_other(int s);
  bool add_vertices(int s, std::uint32_t size);
  void relax(Side& side, std::uint32_t vertex, StarRelaxation::Reach reach);
  void exchange(int rounds, StarRelaxation::Reach reach);
  void bring_features(std::span<const FeaturePoint> features);

  std::array<std::unique_ptr<Side>, 2> sides_;
};

}  // namespace varifold
