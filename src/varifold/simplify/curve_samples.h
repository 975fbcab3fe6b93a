// Discontinuity curves: borders, seams, material borders and non-manifold edges, and the points of
// the original that hold them in place.
//
// Based on: [Hoppe1996] section 4.4 (E_disc: samples on sharp edges, projected to sharp edges).
// Differs: what is a curve is decided by the kinds of the points (vertex_kind.h), and collapses
//   that would change the topology of curves are refused by legality.h, not penalised.
#pragma once

#include <varifold/simplify/sample_blocks.h>
#include <varifold/simplify/working_surface.h>
#include <array>
#include <cstdint>
#include <vector>

namespace varifold {

class CurveSamples {
 public:
  CurveSamples() = default;
  /// A sample at every point of a curve that can move, and one inside each of its edges. O(n).
  explicit CurveSamples(WorkingSurface& surface);

  [[nodiscard]] bool empty() const { return slots_.empty(); }
  /// Whether the point lies inside a curve, so that it may slide along it.
  [[nodiscard]] bool contains(std::uint32_t point) const {
    return !slots_.empty() && slot_of_[point] != kNone;
  }

  /// The part of the curves that a collapse along a curve edge changes. With `moves`, the vertex
  /// that stays goes to a place of its own, else it stays.
  struct Stretch {
    std::array<std::uint32_t, 3> edges{kNone, kNone,
                                       kNone};  ///< far - from, from - onto, onto - next
    std::uint32_t far = kNone;                  ///< the neighbour of `from` on the other side
    std::uint32_t next = kNone;  ///< that of `onto`; kNone where its edge does not change
  };
  [[nodiscard]] Stretch stretch(std::uint32_t from, std::uint32_t onto, bool moves) const;

  [[nodiscard]] double energy(const Stretch& stretch) const;
  /// What it would be with the vertex that stays at `place`.
  [[nodiscard]] double energy_at(const WorkingSurface& surface, const Stretch& stretch,
                                 const Vec3& place) const;
  /// Adds to the least squares problem of the vertex that stays, about `place`, with the samples
  /// projected while it is there: squared weights, and weights times offsets.
  void add_to_fit(const WorkingSurface& surface, const Stretch& stretch, const Vec3& place,
                  double& weight, DVec3& sum) const;
  /// Does the collapse.
  void collapse(const WorkingSurface& surface, std::uint32_t from, std::uint32_t onto,
                const Stretch& stretch, const Vec3& place);

  /// The samples attached to the curve edge between two neighbours; none where it is no such edge.
  [[nodiscard]] std::span<const EnergySample> on_edge(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  // The two curve edges of a point.
  struct Slot {
    std::array<std::uint32_t, 2> neighbor{kNone, kNone}, edge{kNone, kNone};
  };
  struct Foot {
    float squared;   // distance
    float at_place;  // weight of the vertex that stays
    Vec3 off;        // from the foot to the sample
    bool is_far;     // on the edge to `far`, else on that to `next`
  };
  [[nodiscard]] static Foot foot(const WorkingSurface& surface, const Stretch& stretch,
                                 const Vec3& place, const Vec3& sample);
  [[nodiscard]] const Slot* slot(std::uint32_t point) const {
    return contains(point) ? &slots_[slot_of_[point]] : nullptr;
  }
  void find_slots(WorkingSurface& surface);
  void number_edges(const WorkingSurface& surface);
  void replace_neighbor(std::uint32_t point, std::uint32_t old, std::uint32_t neighbor,
                        std::uint32_t edge);

  std::vector<std::uint32_t> slot_of_;  // per point
  std::vector<Slot> slots_;
  SampleBlocks samples_;
};

}  // namespace varifold
