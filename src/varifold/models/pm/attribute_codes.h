// Vertex attributes as whole numbers, their prediction from neighbours, and what remains.
//
// Based on: [Hoppe1996] section 5 (differences to the neighbourhood); [Cigolle2014] (octahedral
//   normals); [LindstromIsenburg2006] section 4 (floats as integers of the same order).
// Differs: the prediction is the mean of the new vertex's ring, and the scale of what remains is
//   guessed from the distance between the prediction and the vertex that is split.
#pragma once

#include <varifold/base/rice_code.h>
#include <varifold/mesh/triangle_mesh.h>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold::pm {

/// Positions, normals, texture coordinates, colours: at most 3 + 3 + 2 + 4 numbers.
inline constexpr std::uint32_t kMaxChannels = 12;
inline constexpr int kMaxPositionBits = 24;
inline constexpr int kMaxNormalBits = 16;
inline constexpr int kMaxTexcoordBits = 24;

enum class Field : std::uint8_t { kPosition, kNormal, kTexcoord, kColor };
inline constexpr std::uint32_t kFieldCount = 4;

/// Which attributes there are, and the grids that they lie on. 0 bits: floats, exactly.
struct AttributeFormat {
  bool normals = false;
  bool texcoords = false;
  bool colors = false;
  int position_bits = 0;
  int normal_bits = 0;  ///< of each of two octahedral coordinates; 0 or at least 2
  int texcoord_bits = 0;
  Vec3 position_origin{0};
  double position_step = 0;
  Vec2 texcoord_origin{0};
  std::array<double, 2> texcoord_step{0, 0};
};

using Codes = std::array<std::uint32_t, kMaxChannels>;

/// The codes to expect, and per channel the model that codes the difference.
struct Prediction {
  Codes codes{};
  std::array<std::uint16_t, kMaxChannels> model{};
};

/// What is known about the numbers in a stream; see RiceModel.
struct CodeModels {
  static constexpr std::uint32_t kScales = 33;
  static constexpr std::uint16_t kPlaced = kFieldCount * kScales;  ///< of a vertex that moves back
  static constexpr std::uint16_t kWedgeCount = 2 * kPlaced;
  static constexpr std::uint16_t kTargetDelta = kWedgeCount + 1;
  static constexpr std::uint16_t kTriangleCount = kWedgeCount + 2;
  static constexpr std::uint16_t kPlacedCount = kWedgeCount + 3;
  static constexpr std::uint16_t kErrorDrop = kWedgeCount + 4;
  static constexpr std::uint16_t kCount = kWedgeCount + 5;

  CodeModels();
  std::array<RiceModel, kCount> model;
};

/// Turns attributes into codes and back; immutable, the same on every system.
class AttributeCoder {
 public:
  AttributeCoder() = default;
  explicit AttributeCoder(const AttributeFormat& format);

  [[nodiscard]] const AttributeFormat& format() const { return format_; }
  [[nodiscard]] std::uint32_t channel_count() const { return channel_count_; }

  [[nodiscard]] Codes encode(const TriangleMesh& attributes, std::uint32_t vertex) const;
  /// Writes the attributes of a vertex; false where a number lies outside of its grid or a position
  /// is not finite.
  [[nodiscard]] bool decode(const Codes& codes, TriangleMesh& attributes,
                            std::uint32_t vertex) const;
  /// Gives the arrays that the format has room for `count` vertices.
  void resize(TriangleMesh& attributes, std::size_t count) const;

  /// Predicts the channels of a field as the mean of `ring`; `near` sets the scale. `table` holds
  /// the codes of all vertices, channel_count() each. An empty ring predicts `near`.
  void predict_mean(Field field, std::span<const std::uint32_t> ring, std::uint32_t near,
                    const std::vector<std::uint32_t>& table, Prediction& prediction) const;
  /// Predicts where a vertex at `old_codes` stands once `split_off` has left it: opposite of it.
  [[nodiscard]] Prediction predict_placed(const Codes& old_codes, const Codes& split_off) const;
  /// Predicts `previous`, with one model a field.
  [[nodiscard]] Prediction predict_next(const Codes& previous) const;

  [[nodiscard]] std::uint32_t first_channel(Field field) const {
    return first_channel_[static_cast<std::size_t>(field)];
  }
  [[nodiscard]] std::uint32_t end_channel(Field field) const {
    return first_channel_[static_cast<std::size_t>(field) + 1];
  }

 private:
  enum class Kind : std::uint8_t { kWhole, kFloat, kOctahedral };

  void choose_models(Field field, const std::uint32_t* near, std::uint32_t first_model,
                     Prediction& prediction) const;
  void mean_of_floats(Field field, std::span<const std::uint32_t> ring,
                      const std::vector<std::uint32_t>& table, Codes& codes) const;
  void mean_of_normals(std::span<const std::uint32_t> ring, const std::vector<std::uint32_t>& table,
                       Codes& codes) const;

  AttributeFormat format_;
  std::uint32_t channel_count_ = 3;
  std::array<std::uint32_t, kFieldCount + 1> first_channel_{0, 3, 3, 3, 3};
  std::array<Kind, kFieldCount> kind_{Kind::kFloat, Kind::kFloat, Kind::kFloat, Kind::kWhole};
};

/// The farthest that a position moves when it is put on the grid and read back, in model units; 0
/// for floats. The grids of `format` are set from the attributes of `mesh` and `placed`.
[[nodiscard]] double fit_grids(const TriangleMesh& mesh, const TriangleMesh& placed,
                               AttributeFormat& format);

}  // namespace varifold::pm
