// Attributes as part of the error: how far the normals, texture coordinates and colours of the
// simplified surface are from those of the original at the same place.
//
// Based on: [Hoppe1999] section 5 (a quadric whose minimum over the attribute is linear in space).
// Differs: quadrics sit at the wedge and its attribute values, so single precision serves; apart from
//   the geometric error, which keeps no memory, they gather what they have met.
#pragma once

#include <array>
#include <cstdint>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/simplify/quadric.h>
#include <vector>

namespace varifold {

/// How much a unit of each attribute weighs against a distance of one bounding-box diagonal.
/// Zero leaves the attribute out of the cost (it still follows along).
struct AttributeWeights {
  float normal = 0.005f;
  float texcoord = 0.02f;
  float color = 0.005f;  ///< colours range over [0, 1]
};

/// Weighted attribute values of every wedge, and the quadrics that tie them to positions.
class AttributeField {
 public:
  static constexpr int kMaxChannels = 9;  // normal 3, texture coordinate 2, colour 4

  AttributeField() = default;
  /// Takes the channels that the mesh has and the weights do not switch off.
  AttributeField(const TriangleMesh& mesh, const AttributeWeights& weights);

  [[nodiscard]] bool empty() const { return channels_ == 0; }
  [[nodiscard]] int channels() const { return channels_; }

  /// The face's linear attribute functions enter the quadric of one of its corners: `wedge` with
  /// edges to the two others.
  void add_face(const std::array<std::uint32_t, 3>& wedges, const Vec3& edge_1,
                const Vec3& edge_2, float weight);

  /// The weighted squared attribute error when `wedge` moves by `d` and takes the values of `onto`.
  [[nodiscard]] float cost(std::uint32_t wedge, std::uint32_t onto, const Vec3& d) const;

  /// Moves the quadric of `wedge` by `d` to the values of `onto` and adds it there.
  void merge(std::uint32_t wedge, std::uint32_t onto, const Vec3& d);

  /// The squared weighted difference of two wedges.
  [[nodiscard]] float distance_squared(std::uint32_t a, std::uint32_t b) const;

  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Term {
    Vec3 gradient{0};  ///< sum of weight * gradient
    float offset = 0;  ///< sum of weight * (value of the plane at the origin - own value)
  };
  [[nodiscard]] float coupling(std::uint32_t wedge, std::uint32_t onto, const Vec3& d) const;
  [[nodiscard]] const float* values(std::uint32_t wedge) const {
    return &values_[std::size_t{wedge} * channels_];
  }

  int channels_ = 0;
  std::vector<float> values_;
  std::vector<Quadric> quadrics_;  // per wedge: the part without the values
  std::vector<Term> terms_;        // per wedge and channel: what couples values and place
  std::vector<float> weights_;
};

}  // namespace varifold
