// The faces around the vertex that a collapse leaves, and the distances of samples to them.
#pragma once

#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// A collapse of `from` onto its neighbour `onto`. If it `moves` the vertex that stays, all faces
/// around that change; otherwise only those of `from` do.
struct FanEdge {
  std::uint32_t from, onto;
  bool moves;
};

/// A face (apex, m, n), the apex being the vertex that stays.
struct FanFace {
  std::uint32_t face, m, n;
  bool was_from;  ///< it had `from` as its corner before, else `onto`
  bool changes;   ///< false: it only receives samples
};

/// The faces that samples go to when an edge collapses: those that the collapse changes and, where
/// it leaves the faces of `onto` as they are, the ones beside the faces that vanish.
void make_fan(const WorkingSurface& surface, const FanEdge& edge, std::vector<FanFace>& fan);

/// Appends the live faces that the collapse changes or removes, each once. O(rings).
void changed_faces(const WorkingSurface& surface, const FanEdge& edge,
                   std::vector<std::uint32_t>& faces);

/// Samples axis by axis, padded to blocks that fit a vector register, and the nearest face found
/// for each.
class FanDistances {
 public:
  static constexpr std::size_t kBlock = 4;

  void clear() { size_ = 0; }
  /// Keeps the first `size` samples.
  void cut(std::size_t size) { size_ = size; }
  void add(const Vec3& position);
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] Vec3 operator[](std::size_t i) const { return {x_[i], y_[i], z_[i]}; }

  /// Sum of the squared distances of all samples to the fan with its apex at `apex`; more than
  /// `limit`, but not the sum, as soon as it exceeds that. O(samples x faces).
  [[nodiscard]] double sum(const WorkingSurface& surface, std::span<const FanFace> fan,
                           const Vec3& apex, double limit);
  /// The same, noting for each sample the distance and the place of the nearest face in the fan.
  void find_nearest(const WorkingSurface& surface, std::span<const FanFace> fan, const Vec3& apex);
  [[nodiscard]] float squared(std::size_t i) const { return squared_[i]; }
  [[nodiscard]] std::uint32_t nearest(std::size_t i) const {
    return static_cast<std::uint32_t>(nearest_[i]);
  }

 private:
  // What distances to a face need that does not depend on the sample; about the apex.
  struct Plan {
    Vec3 m, rim, n;           // corner m, the edge from m to n, corner n
    Vec3 normal, to_m, to_n;  // unit normal; their products with a place are its weights at m and n
    float m_scale, rim_scale, n_scale;  // one over the squared length
    bool needs_n;                       // no other face measures the edge from the apex to n
  };
  void make_plans(const WorkingSurface& surface, std::span<const FanFace> fan, const Vec3& apex);
  void pad();
  template <bool kWithFace>
  void measure(std::size_t begin, std::size_t end, const Vec3& apex);

  std::vector<float> x_, y_, z_, squared_;
  std::vector<std::int32_t> nearest_;
  std::vector<Plan> plans_;
  std::size_t size_ = 0;
};

}  // namespace varifold
