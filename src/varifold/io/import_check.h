// The last step of every mesh reader: what holds for an ImportedMesh is made to hold here.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/imported_mesh.h>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace varifold {

/// Checks sizes, indices, ranges and positions, replaces normals and texture coordinates that are
/// not finite by zero, and warns of these and of a mesh without triangles. O(n).
/// Errors: kInvalidInput naming the first bad vertex or triangle; kUnsupported where vertices or
/// corners need more than 32 bits.
[[nodiscard]] Result<ImportedMesh> finish_import(ImportedMesh imported);

/// Error kInvalidInput naming the first vertex whose position is not finite. O(vertices).
[[nodiscard]] Result<void> check_positions(const TriangleMesh& mesh);

/// Gives the vertices that are marked the unit normals of their triangles, weighted by area; zero
/// where these have none. Positions and indices must be valid. O(n).
void fill_missing_normals(TriangleMesh& mesh, const std::vector<bool>& is_missing);

/// Appends "<count> <what>" to the warnings unless the count is 0; `what` is in the plural.
void warn_count(ImportedMesh& imported, std::size_t count, std::string_view what);

/// A colour component in [0, 1] as a byte, rounded; what is below or not a number becomes 0, what
/// is above 255. The exact byte for byte / 255.
[[nodiscard]] inline std::uint8_t color_byte(float value) {
  const float scaled = value * 255 + 0.5f;
  return scaled >= 255 ? 255 : scaled > 0 ? static_cast<std::uint8_t>(scaled) : 0;
}

/// Text of a file as it may stand in a message: one line of at most 60 printable characters, in
/// quotes.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace varifold
