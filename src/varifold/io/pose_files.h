// The poses of a mesh from files of one connectivity.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/imported_mesh.h>
#include <filesystem>
#include <span>

namespace varifold {

/// Reads the mesh `rest` and appends a pose for every file of `poses`, in their order and named by
/// the stem of the file: its positions, and its normals where both files have them. All else comes
/// from `rest`; texture coordinates, colours and materials of a pose that differ are named in the
/// warnings.
///
/// The files must have the same triangles, index for index. In OBJ files that are the numbers after
/// `f` that name a `v`: where programs number the texture coordinates and normals of every pose
/// anew, the seams are still those of `rest`, and a vertex of it for which the pose has several
/// normals gets their mean. Polygons are cut as in `rest`, whatever their shape in a pose.
///
/// O(files). Errors: those of read_mesh(), and kInvalidInput with the first difference:
/// "b.ply: triangle 12 is 3 4 5, in a.ply 3 5 4"; numbers are from 0.
[[nodiscard]] Result<ImportedMesh> read_pose_files(const std::filesystem::path& rest,
                                                   std::span<const std::filesystem::path> poses);

}  // namespace varifold
