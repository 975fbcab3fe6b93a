// Model files: what a model encodes itself to, in a .vfm container.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/container_table.h>
#include <varifold/models/pm/encoding.h>
#include <varifold/models/pm/progressive_mesh.h>
#include <cstdint>
#include <filesystem>

namespace varifold {

/// The kind of a container that holds a progressive mesh, and the tag of its only chunk: a stream
/// of encode_progressive_mesh(). It stands last, so that a reader of a pipe (ContainerStream,
/// ProgressiveStreamReader) can refine while it arrives; other chunks may come before it.
inline constexpr std::uint32_t kProgressiveMeshKind = fourcc("pm  ");
inline constexpr std::uint32_t kProgressiveMeshStream = fourcc("STRM");

struct ModelFileOptions {
  EncodeOptions encoding;
  /// With zstd on top, where that makes the file smaller.
  bool compress = false;
};

struct ModelFileReport {
  std::uint64_t file_bytes = 0;
  std::uint64_t stream_bytes = 0;  ///< of the encoded model, before zstd
  std::uint64_t base_bytes = 0;    ///< of these, what stands before the splits
  float position_error = 0;        ///< the farthest that a position moved by rounding
};

/// Writes a model; the file appears whole or not at all. The same bytes for the same model and
/// options. O(n). Errors: kFailed; the message begins with the path.
[[nodiscard]] Result<ModelFileReport> write_model(const ProgressiveMesh& model,
                                                  const std::filesystem::path& path,
                                                  const ModelFileOptions& options = {});

/// Reads a progressive mesh; from a pipe too. All checksums are verified. O(n).
/// Errors: kUnreadable, kInvalidInput, kUnsupported (another kind of model); the message begins
/// with the path and names the place.
[[nodiscard]] Result<ProgressiveMesh> read_progressive_mesh(const std::filesystem::path& path);

}  // namespace varifold
