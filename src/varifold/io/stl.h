// STL, the triangle soup of stereolithography: binary and ASCII.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/imported_mesh.h>
#include <cstddef>
#include <span>

namespace varifold {

/// Whether the file's size is that of a binary STL with the triangle count that it states. This is
/// surer than the first word, which is "solid" in some binary files.
[[nodiscard]] bool has_binary_stl_size(std::span<const std::byte> file);

/// Reads an STL file, binary or ASCII with any number of solids. Corners at equal positions become
/// one vertex, in the order of first use; facet normals are dropped, as they follow from the
/// corners, and so are attribute bytes, with a warning.
/// O(file). Errors: kInvalidInput, "line 12: ..." or "facet 3: ...".
[[nodiscard]] Result<ImportedMesh> read_stl(std::span<const std::byte> file);

}  // namespace varifold
