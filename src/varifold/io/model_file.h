// Model files: what a model encodes itself to, in a .vfm container.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/any_model.h>
#include <varifold/models/pm/encoding.h>
#include <varifold/models/pm/progressive_mesh.h>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace varifold {

/// The kind of a container that holds a progressive mesh, and the tag of its main chunk: a stream
/// of encode_progressive_mesh(). It stands last, so that a reader of a pipe (ContainerStream,
/// ProgressiveStreamReader) can refine while it arrives; other chunks may come before it.
inline constexpr std::uint32_t kProgressiveMeshKind = ModelKind<ProgressiveMesh>::kFourcc;
inline constexpr std::uint32_t kProgressiveMeshStream = ModelKind<ProgressiveMesh>::kChunk;
/// The chunk before it, of models that have skin, poses or rig: encode_deformation().
inline constexpr std::uint32_t kDeformationChunk = fourcc("POSE");

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

/// Writes a chunk that a model encoded itself to; what the overloads below call.
[[nodiscard]] Result<ModelFileReport> write_model_chunk(std::uint32_t kind, std::uint32_t tag,
                                                        std::vector<std::byte> bytes, bool compress,
                                                        const std::filesystem::path& path);

/// The same for any other kind of model (any_model.h), in one chunk.
template <class Model>
[[nodiscard]] Result<ModelFileReport> write_model(const Model& model,
                                                  const std::filesystem::path& path,
                                                  bool compress = !ModelKind<Model>::kDense) {
  using Kind = ModelKind<Model>;
  return write_model_chunk(Kind::kFourcc, Kind::kChunk, Kind::encode(model), compress, path);
}

/// Reads a model of any kind; from a pipe too. All checksums are verified. O(n).
/// Errors: kUnreadable, kInvalidInput, kUnsupported (a kind that is not in any_model.h); the
/// message begins with the path and names the place.
[[nodiscard]] Result<AnyModel> read_any_model(const std::filesystem::path& path);

/// Reads a progressive mesh; from a pipe too. All checksums are verified. O(n).
/// Errors: kUnreadable, kInvalidInput, kUnsupported (another kind of model); the message begins
/// with the path and names the place.
[[nodiscard]] Result<ProgressiveMesh> read_progressive_mesh(const std::filesystem::path& path);

}  // namespace varifold
