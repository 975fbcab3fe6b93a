// Attributes as part of the error: how far the normals, texture coordinates and colours of the
// simplified surface are from those of the original at the same place.
//
// Based on: [Hoppe1999] section 5 (a quadric whose minimum over the attribute is linear in space).
// Differs: quadrics sit at the wedge and its attribute values, so single precision serves; apart
// from
//   the geometric error, which keeps no memory, they gather what they have met.
#pragma once

#include <varifold/base/large_vector.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/simplify/quadric.h>
#include <array>
#include <cstdint>
#include <span>
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
  /// Takes the channels that the mesh has and the weights do not switch off; wedge w has the
  /// attributes of vertex vertex_of[w].
  AttributeField(const TriangleMesh& mesh, std::span<const std::uint32_t> vertex_of,
                 const AttributeWeights& weights);

  [[nodiscard]] bool empty() const { return channel_count_ == 0; }
  [[nodiscard]] int channel_count() const { return channel_count_; }

  /// The weighted values of a wedge, channel by channel; zero beyond channel_count().
  using Values = std::array<float, kMaxChannels>;
  [[nodiscard]] Values values(std::uint32_t wedge) const;

  /// The face's linear attribute functions enter the quadric of one of its corners: `wedge` with
  /// edges to the two others.
  void add_face(const std::array<std::uint32_t, 3>& wedges, const Vec3& edge_1, const Vec3& edge_2);

  /// The weighted squared attribute error when `wedge` moves by `d` and takes the values of `onto`.
  [[nodiscard]] float cost(std::uint32_t wedge, std::uint32_t onto, const Vec3& d) const;

  /// Moves the quadric of `wedge` by `d` to the values of `onto` and adds it there.
  void merge(std::uint32_t wedge, std::uint32_t onto, const Vec3& d);

  /// Two wedges that become one at a place of its own: with values t of the way from those of
  /// `wedge` to those of `onto`, `d` and `onto_d` away from them.
  struct Blend {
    std::uint32_t wedge, onto;
    float t;
    Vec3 d, onto_d;
  };
  [[nodiscard]] float cost(const Blend& blend) const;
  /// The values that `onto` would get.
  [[nodiscard]] Values blended(const Blend& blend) const;
  /// Does so: `onto` gets the values and both quadrics.
  void merge(const Blend& blend);

  /// The squared weighted difference of two wedges.
  [[nodiscard]] float distance_squared(std::uint32_t a, std::uint32_t b) const;

  [[nodiscard]] std::size_t bytes() const;

 private:
  // All of a wedge lies together: what does not depend on the values as a quadric, then for each
  // channel the value, and what couples it to the place: the sum over the faces of weight *
  // gradient, and of weight * (value of the face's linear function at the origin - own value).
  struct Channel {
    float value = 0;
    float offset = 0;
    Vec3 gradient{0};
  };
  struct Head {
    Quadric quadric;
    float weight = 0;
  };
  static constexpr std::size_t kHeadFloats = sizeof(Head) / sizeof(float);
  static constexpr std::size_t kChannelFloats = sizeof(Channel) / sizeof(float);

  [[nodiscard]] Head& head(std::uint32_t wedge) {
    return *reinterpret_cast<Head*>(&data_[wedge * stride_]);
  }
  [[nodiscard]] const Head& head(std::uint32_t wedge) const {
    return *reinterpret_cast<const Head*>(&data_[wedge * stride_]);
  }
  [[nodiscard]] Channel* channels(std::uint32_t wedge) {
    return reinterpret_cast<Channel*>(&data_[wedge * stride_ + kHeadFloats]);
  }
  [[nodiscard]] const Channel* channels(std::uint32_t wedge) const {
    return reinterpret_cast<const Channel*>(&data_[wedge * stride_ + kHeadFloats]);
  }
  [[nodiscard]] float coupling(std::uint32_t wedge, const Values& values, const Vec3& d) const;
  [[nodiscard]] float cost(std::uint32_t wedge, const Values& values, const Vec3& d) const;
  /// Moves the quadric of a wedge, in place, to another origin and other values.
  void move(std::uint32_t wedge, const Values& values, const Vec3& d);
  /// Adds the quadric of `wedge` to that of `onto`, which has the same origin and values.
  void add(std::uint32_t wedge, std::uint32_t onto);

  int channel_count_ = 0;
  std::size_t stride_ = 0;  // floats a wedge
  LargeVector<float> data_;
};

}  // namespace varifold
