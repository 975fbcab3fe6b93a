// Which property of a PLY vertex goes where in a TriangleMesh.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/import_check.h>
#include <varifold/io/ply_header.h>
#include <varifold/mesh/triangle_mesh.h>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace varifold::ply {

/// One property and its place: value `row` goes to floats[row * stride] or, scaled and rounded, to
/// bytes[row * stride].
struct Column {
  std::uint32_t property = 0;
  float* floats = nullptr;
  std::uint8_t* bytes = nullptr;
  std::size_t stride = 0;
  float scale = 1;                    ///< of colours: to [0, 1]
  std::size_t* not_finite = nullptr;  ///< counts colour components that are not finite

  void store(std::size_t row, float value) const {
    if (floats) {
      floats[row * stride] = value;
      return;
    }
    if (!std::isfinite(value)) ++*not_finite;
    bytes[row * stride] = color_byte(value * scale);
  }
};

/// The columns of a vertex element, bound to the arrays of a mesh, which it sizes: the caller has
/// checked that the file has bytes for element.count rows. Colour components that are not finite
/// are counted in `not_finite`, which the columns refer to.
/// Errors: kInvalidInput where x, y or z are missing.
[[nodiscard]] Result<std::vector<Column>> bind_columns(const Element& element, TriangleMesh& mesh,
                                                       std::size_t& not_finite);

/// Decodes one column of `rows` binary rows of equal size, beginning with row `first_row`; `first`
/// points to the property in that row.
struct RowBlock {
  const std::byte* first = nullptr;
  std::size_t row_bytes = 0;
  std::size_t first_row = 0;
  std::size_t rows = 0;
};
void decode_column(const Column& column, Type type, Encoding encoding, const RowBlock& block);

/// One binary value as a float; and as a whole number (of a float type: 0).
[[nodiscard]] float load_float(Type type, Encoding encoding, const std::byte* from);
[[nodiscard]] std::int64_t load_integer(Type type, Encoding encoding, const std::byte* from);

}  // namespace varifold::ply
