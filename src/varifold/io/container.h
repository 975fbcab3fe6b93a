// The .vfm container: a kind and a list of tagged, checksummed, perhaps compressed chunks. The
// format is described byte by byte in docs/formats/vfm.md.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/container_table.h>
#include <varifold/io/mapped_file.h>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace varifold {

/// A chunk to be written.
struct Chunk {
  std::uint32_t tag = 0;  ///< fourcc(); each tag once in a file
  std::vector<std::byte> bytes;
  /// With zstd, where that makes the chunk smaller and expands to no more than readers allow.
  bool compress = false;
};

/// A .vfm file of these chunks in this order. The same bytes for the same input and version of
/// zstd. O(bytes). Errors: kFailed where a tag occurs twice or there are more than 4096 chunks.
[[nodiscard]] Result<std::vector<std::byte>> encode_container(std::uint32_t kind,
                                                              std::span<const Chunk> chunks);

/// A whole .vfm file in memory. Chunks are verified, and decompressed, when they are first asked
/// for; tags that a program does not ask for are skipped. Move-only.
class Container {
 public:
  /// Opens a file; it stays mapped as long as the object lives. Errors begin with the path.
  [[nodiscard]] static Result<Container> open(const std::filesystem::path& path);

  /// Reads the bytes where they are: they must outlive the object. Checks header, chunk table and
  /// padding, not yet the chunks. O(chunks). Errors: kInvalidInput, kUnsupported; "byte N: ...".
  [[nodiscard]] static Result<Container> parse(std::span<const std::byte> file);

  [[nodiscard]] std::uint32_t kind() const { return table_.kind; }
  [[nodiscard]] const std::vector<ChunkInfo>& chunks() const { return table_.chunks; }
  [[nodiscard]] bool has(std::uint32_t tag) const;

  /// The bytes of a chunk, verified and decompressed; valid as long as the container, also when it
  /// is moved. Chunks that are not compressed are not copied, and aligned to 16 bytes where the
  /// file is. Errors: kInvalidInput, "chunk 'VERT': ...", also where there is no such chunk.
  [[nodiscard]] Result<std::span<const std::byte>> find(std::uint32_t tag);

  /// Verifies and decompresses all chunks, also those that nobody will ask for. O(bytes).
  [[nodiscard]] Result<void> verify();

 private:
  Container() = default;
  [[nodiscard]] Result<std::span<const std::byte>> load_chunk(std::size_t index);

  std::string name_;  ///< put before messages; empty without a file
  std::optional<MappedFile> mapping_;
  std::span<const std::byte> file_;
  ContainerTable table_;
  struct State {
    bool is_verified = false;
    std::vector<std::byte> raw;  ///< of compressed chunks
  };
  std::vector<State> states_;
};

}  // namespace varifold
