// The byte form of a progressive mesh, made for transmission: every prefix that holds the base is a
// progressive mesh too, one that ends at the last split which is there as a whole.
//
// Based on: [Hoppe1996] sections 3.2 and 3.4 (progressive transmission, compression).
// Differs: see split_record.h. The bytes are described in docs/formats/progressive_mesh.md.
#pragma once

#include <varifold/base/result.h>
#include <varifold/models/pm/progressive_mesh.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Bits of the grids that attributes are rounded to; 0 keeps the floats, exactly.
struct EncodeOptions {
  int position_bits = 0;  ///< per axis, of the longest side of the bounding box; at most 24
  int normal_bits = 0;    ///< of each of two octahedral coordinates; 0 or 2 to 16
  int texcoord_bits = 0;  ///< per axis, of the range of that axis; at most 24
};

struct EncodeReport {
  /// The farthest that a position moves by rounding, in model units; 0 for floats. Where errors are
  /// measured (ProgressiveMeshData::error_is_measured), those of the stream are greater by this,
  /// so that they still bound the distance of the vertices of the mesh that was not rounded.
  float max_position_error = 0;
  std::size_t base_bytes = 0;  ///< all that stands before the splits
};

/// With the default options decode_progressive_mesh() gives the same model, byte for byte; where
/// the model comes from build_progressive_mesh() or from a decoder. Skin, poses and rig are left
/// out: deformation.h has them. Options beyond their limits are cut. About 7 bytes a vertex for
/// positions of 16 bits, 11 for floats. O(n) time.
[[nodiscard]] std::vector<std::byte> encode_progressive_mesh(const ProgressiveMesh& model,
                                                             const EncodeOptions& options = {},
                                                             EncodeReport* report = nullptr);

/// The model in `bytes`, or in that part of a stream: then its finest level is the last one that is
/// there as a whole, and its errors are still distances to the whole mesh.
/// Errors: kInvalidInput with the offset of the fault, when the bytes are damaged or end before the
/// base does. Accepts any bytes; O(bytes) time and memory.
[[nodiscard]] Result<ProgressiveMesh> decode_progressive_mesh(std::span<const std::byte> bytes);

/// How many of the first bytes hold the levels up to `level`, and none beyond it; all bytes where
/// there are fewer levels. O(bytes): reads the stream. Errors as decode_progressive_mesh().
[[nodiscard]] Result<std::size_t> progressive_mesh_prefix(std::span<const std::byte> bytes,
                                                          std::uint32_t level);

}  // namespace varifold
