// How far the eye, the planes of the frustum and the tolerance have moved: the clocks by which
// decisions fall due.
//
// Based on: exact slack, an idea of this project; see docs/algorithms/view_dependent_mesh.md.
#pragma once

#include <varifold/models/vdpm/view_query.h>
#include <varifold/view/sphere.h>
#include <array>
#include <bit>
#include <cstdint>

namespace varifold {

/// One odometer per Mover. An answer whose slack is s cannot change before its odometer has gone
/// on by s: the odometers bound from above what the gaps of ViewQuery may have changed for any
/// region inside a ball, the mesh.
///
/// Those of kApproach and kRecede may go back: the distance to a point of the mesh changes as that
/// to the mesh's centre does, up to the angle between the two lines of sight.
class Odometers {
 public:
  static constexpr std::size_t kCount = 8;  // as many as the lanes of a vector

  Odometers() = default;
  explicit Odometers(const Sphere& mesh) : mesh_(mesh) { rebase(); }

  /// The distance that all regions are within, seen from an eye, with some to spare: what ViewQuery
  /// takes as its reach. Grows with the eye; forget() lets it shrink.
  [[nodiscard]] float reach(const Vec3& eye, float near_distance);
  /// Whether the reach is now so much too great that it is worth to begin anew.
  [[nodiscard]] bool reach_is_stale() const { return reach_ > 4 * present_reach_; }
  /// Only after this may the reach shrink; all keys must then be made anew.
  void forget() { reach_ = 0; }

  /// From one view to the next. False when nothing moved.
  bool advance(const ViewQuery& from, const ViewQuery& to);

  /// The keys of answers: due when the odometer has reached them. Odometer and key in one float,
  /// whose last three bits name the odometer.
  [[nodiscard]] float key(Mover mover, float slack) const;
  /// As floats rounded up, in the order of Mover; kNothing is never reached.
  [[nodiscard]] const std::array<float, kCount>& now() const { return now_; }
  /// What keys add their slack to: the totals as floats rounded down.
  [[nodiscard]] const std::array<float, kCount>& base() const { return base_; }
  [[nodiscard]] bool is_due(float key) const {
    return now_[std::bit_cast<std::uint32_t>(key) & 7u] >= key;
  }

  /// Whether the numbers have grown (or shrunk) so far that keys lose their last digits; then all
  /// keys must be made anew after rebase().
  [[nodiscard]] bool is_worn() const;
  void rebase();

 private:
  void round();

  Sphere mesh_;
  float reach_ = 0, present_reach_ = 0;
  std::array<double, kCount> total_{};
  std::array<float, kCount> now_{}, base_{};
};

}  // namespace varifold
