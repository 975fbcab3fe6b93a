// Mesh files of every format that Varifold knows.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/imported_mesh.h>
#include <varifold/strip/triangle_strips.h>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

namespace varifold {

enum class MeshFormat { kPly, kObj, kStl, kGltf, kGlb };

/// The format by content first, by the extension of `path` second; nothing where neither tells.
/// O(1): looks at the first kilobytes.
[[nodiscard]] std::optional<MeshFormat> mesh_format(std::span<const std::byte> file,
                                                    const std::filesystem::path& path);

/// Reads a mesh from memory. `folder` is where files lie that it names (materials, buffers); with
/// an empty folder no file is opened.
/// Errors: kInvalidInput or kUnsupported; the message begins with the place in the file.
[[nodiscard]] Result<ImportedMesh> decode_mesh(std::span<const std::byte> file, MeshFormat format,
                                               const std::filesystem::path& folder = {},
                                               FaceReading faces = FaceReading::kForUse);

/// Reads a mesh file: PLY, OBJ, STL, glTF or GLB. O(file) time and memory.
/// Errors: kUnreadable, kInvalidInput, kUnsupported; the message begins with the path:
/// "bunny.ply: line 12: ...".
[[nodiscard]] Result<ImportedMesh> read_mesh(const std::filesystem::path& path,
                                             FaceReading faces = FaceReading::kForUse);

/// Writes a mesh by the extension of `path`: .ply (binary), .obj (with a .mtl file and image files
/// beside it where there are materials) or .glb. Files appear whole or not at all. What the format
/// cannot hold is left out: see unwritten_parts().
/// `strips` are written in place of the triangles: PLY has restarts, GLB wants them joined by
/// degenerates, OBJ has no strips (kUnsupported).
/// Errors: kFailed, the message begins with the path.
[[nodiscard]] Result<void> write_mesh(const TriangleMesh& mesh, const std::filesystem::path& path,
                                      const JoinedStrips* strips = nullptr);

/// One line for every part of the mesh that write_mesh() would leave out for want of a place in the
/// format: "materials", ...
[[nodiscard]] std::vector<std::string> unwritten_parts(const TriangleMesh& mesh, MeshFormat format);

}  // namespace varifold
