// A .glb file in the making: the JSON and the binary chunk side by side.
#pragma once

#include <varifold/base/math.h>
#include <varifold/base/result.h>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

namespace varifold::gltf {

using OutputJson = nlohmann::ordered_json;

/// Accessors of one buffer; each function returns the index of what it has added.
class Output {
 public:
  /// What a buffer view is for.
  enum class Target { kNone = 0, kVertices = 34962, kIndices = 34963 };

  OutputJson document;

  /// Rows of `width` floats: "SCALAR", "VEC2", ..., "MAT4".
  std::size_t add_floats(std::span<const float> values, const char* type, std::size_t width,
                         Target target);
  /// The same of vectors.
  template <class V>
  std::size_t add_vectors(const std::vector<V>& values, const char* type) {
    static_assert(sizeof(V) == V::length() * sizeof(float));
    const float* const first = values.empty() ? nullptr : &values[0][0];
    return add_floats({first, values.size() * V::length()}, type, V::length(), Target::kVertices);
  }
  /// Offsets of the places or normals of all vertices: those that are not 0 alone where they are
  /// few.
  std::size_t add_offsets(const std::vector<Vec3>& offsets);
  /// Rows of `width` bytes or 16-bit numbers, which `values` are small enough for.
  std::size_t add_bytes(std::span<const std::uint8_t> values, const char* type, std::size_t width,
                        bool normalized);
  std::size_t add_shorts(std::span<const std::uint16_t> values, const char* type,
                         std::size_t width);
  /// 16 or 32 bits each: the largest value of a type would restart a strip, so that it is no index.
  std::size_t add_indices(std::span<const std::uint32_t> indices, std::size_t vertex_count);
  /// Gives the newest accessor the least and the largest value of each column.
  void set_bounds(std::span<const float> values, std::size_t width);

  std::size_t add_view(std::span<const std::byte> bytes, Target target);

  /// Errors: kFailed where the file would be longer than the format can express.
  [[nodiscard]] Result<std::vector<std::byte>> assemble();

 private:
  std::size_t add_accessor(int component_type, const char* type, std::size_t count,
                           std::size_t view);

  std::vector<std::byte> binary_;
};

/// JSON has no infinities.
[[nodiscard]] float finite_or(float value, float fallback);

}  // namespace varifold::gltf
