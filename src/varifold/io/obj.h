// Wavefront OBJ and its material files.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/imported_mesh.h>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace varifold {

/// Reads an OBJ file: v (with colours in [0, 1] after the position, where given), vt, vn, f in all
/// its forms with positive or negative indices, usemtl and mtllib; groups, objects and smoothing
/// are ignored; points, lines and curves are dropped with a warning. Polygons are cut into
/// triangles.
///
/// Every distinct triple (v, vt, vn) becomes a vertex, in the order of first use; in a file whose
/// faces have neither vt nor vn the vertices are those of the file, used or not. A corner without
/// vt in a file where others have them gets (0, 0), one without vn the normal of its triangles.
/// Textures begin at the lower left in OBJ
/// and at the upper left in TriangleMesh (as in glTF), so v becomes 1 - v. Material files are
/// looked for below `folder`; each name after usemtl becomes a material, known or not.
///
/// O(file). Errors: kInvalidInput, "line 12: ...".
[[nodiscard]] Result<ImportedMesh> read_obj(std::span<const std::byte> file,
                                            const std::filesystem::path& folder = {},
                                            FaceReading faces = FaceReading::kForUse);

/// An OBJ file and what belongs beside it.
struct ObjFiles {
  std::vector<std::byte> obj;
  std::vector<std::byte> materials;  ///< the file stem + ".mtl"; empty where not needed
  struct ImageFile {
    std::string name;
    std::size_t image;  ///< whose bytes, in TriangleMesh::images
  };
  std::vector<ImageFile> images;
};

/// The mesh as an OBJ file that is to be called `stem` + ".obj", with all attributes and materials;
/// floats have the digits that they need to be read back exactly. Vertices that share position and
/// colour share a `v`, where there are normals or texture coordinates to tell them apart. Alpha of
/// vertex colours has no place in OBJ.
[[nodiscard]] ObjFiles write_obj(const TriangleMesh& mesh, std::string_view stem);

}  // namespace varifold
