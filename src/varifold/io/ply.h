// PLY, the polygon file format of Stanford [Turk1994]: ASCII and binary of both byte orders.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/imported_mesh.h>
#include <varifold/strip/triangle_strips.h>
#include <cstddef>
#include <span>
#include <vector>

namespace varifold {

/// Reads a PLY file. From the element "vertex": x y z; nx ny nz; s t, u v or texture_u texture_v;
/// red green blue with or without alpha (whole numbers of 8 or 16 bits, or floats in [0, 1]). From
/// "face": the list vertex_indices or vertex_index; polygons are cut into triangles. From
/// "tristrips": strips with alternating winding, where -1 begins a new one and triangles with equal
/// corners are dropped. Properties may have any order and type; others are skipped. A comment
/// "TextureFile name" becomes a material with that image; then, but only then, t becomes 1 - t, as
/// these images begin at the lower left and those of TriangleMesh at the upper left. Vertices keep
/// their order and number.
///
/// O(file). Errors: kInvalidInput, "line 12: ..." in the header and in ASCII files, "byte 345: ..."
/// and the number of the element in binary ones.
[[nodiscard]] Result<ImportedMesh> read_ply(std::span<const std::byte> file,
                                            FaceReading faces = FaceReading::kForUse);

struct PlyOptions {
  bool ascii = false;  ///< text instead of binary little-endian; floats survive exactly in both
  /// To be written in place of the triangles, over the vertices of the mesh: as one entry of the
  /// element "tristrips", with -1 for restarts and between ranges.
  const JoinedStrips* strips = nullptr;
};

/// The mesh as a PLY file with float positions, normals (nx ny nz), texture coordinates (s t) and
/// uchar colours, where present. PLY knows no materials: of a single one the base colour's file is
/// kept, as read_ply() reads it.
[[nodiscard]] std::vector<std::byte> write_ply(const TriangleMesh& mesh,
                                               const PlyOptions& options = {});

}  // namespace varifold
