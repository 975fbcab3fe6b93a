// glTF 2.0, as JSON (.gltf) and in one binary file (.glb).
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/imported_mesh.h>
#include <varifold/strip/triangle_strips.h>
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace varifold {

/// Reads a glTF 2.0 asset, JSON or binary, told by its first bytes. All triangles, strips and fans
/// of the default scene (else the first scene, else all nodes without a parent, else all meshes)
/// come into one mesh, moved by their nodes; triangles are sorted by material. Primitives of a node
/// that name the same accessors share their vertices. Carried: POSITION, NORMAL, TEXCOORD_0,
/// COLOR_0, materials, images, morph targets (as poses), skins and animations (as a rig); other
/// attributes, points and lines are dropped with a warning. Where only some primitives have
/// normals, the others get those of their triangles; missing colours are white, missing texture
/// coordinates (0, 0).
///
/// Every instance of a mesh with targets has poses of its own, which leave all other vertices at
/// rest. Skinned vertices stay in the space that their skin was bound in; where there are any, or
/// an animated node moves a mesh, all other vertices follow one joint each, their node or one that
/// stands still. See docs/formats/meshes.md.
///
/// Buffers may be in the file, in data: URIs or in files below `folder`. KHR_mesh_quantization is
/// read; required extensions that change what is drawn and are not known are an error.
///
/// O(file + vertices of all instances * poses); these may not multiply a file to more than 64 times
/// its size and 256 MiB. Errors: kInvalidInput, kUnsupported or kUnreadable, beginning with the
/// JSON element: "accessors[3]: 12 bytes past the end of bufferViews[1]".
[[nodiscard]] Result<ImportedMesh> read_gltf(std::span<const std::byte> file,
                                             const std::filesystem::path& folder = {});

/// The mesh as a binary glTF with all attributes, materials and images; one primitive per material
/// range; poses as morph targets, the rig as nodes, one skin and animations. Floats are exact, but
/// for poses, whose offsets are rounded. Images that the mesh only names stay references.
/// With `strips` (over the vertices of the mesh, joined by degenerates, as glTF has no restarts)
/// these are written in place of the triangles, one primitive of triangle strips per range.
/// Errors: kFailed where the file would be longer than the 4 GiB that the format can express.
[[nodiscard]] Result<std::vector<std::byte>> write_glb(const TriangleMesh& mesh,
                                                       const JoinedStrips* strips = nullptr);

}  // namespace varifold
