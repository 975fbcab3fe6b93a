// The head of a .vfm file: what Container and ContainerStream agree on. See docs/formats/vfm.md.
#pragma once

#include <varifold/base/result.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace varifold {

/// Four characters as a number whose little-endian bytes they are, so that they read as text in
/// the file: fourcc("VERT").
[[nodiscard]] constexpr std::uint32_t fourcc(const char (&text)[5]) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(text[i]);
  return value;
}

/// The four characters in quotes, for messages; as a hexadecimal number where they do not print.
[[nodiscard]] std::string fourcc_name(std::uint32_t code);

/// One entry of the chunk table.
struct ChunkInfo {
  std::uint32_t tag = 0;
  bool compressed = false;
  std::uint64_t offset = 0;       ///< from the start of the file; a multiple of 16
  std::uint64_t stored_size = 0;  ///< bytes in the file
  std::uint64_t raw_size = 0;     ///< bytes after decompression
  std::uint64_t checksum = 0;     ///< XXH3-64 of the stored bytes
};

/// Header and chunk table.
struct ContainerTable {
  std::uint32_t kind = 0;
  std::uint64_t file_size = 0;
  std::vector<ChunkInfo> chunks;
};

namespace container {

inline constexpr std::size_t kHeaderBytes = 32;
inline constexpr std::size_t kEntryBytes = 40;
inline constexpr std::size_t kChecksumBytes = 8;
inline constexpr std::size_t kAlignment = 16;
inline constexpr std::uint32_t kVersion = 1;
inline constexpr std::uint32_t kMostChunks = 4096;
/// Compressed chunks must not need a larger window than this to be decoded piece by piece.
inline constexpr int kWindowLog = 23;

[[nodiscard]] constexpr std::uint64_t aligned(std::uint64_t position) {
  return (position + kAlignment - 1) / kAlignment * kAlignment;
}
/// The most bytes that a compressed chunk may expand to.
[[nodiscard]] constexpr std::uint64_t most_raw_bytes(std::uint64_t stored_size) {
  return 1000 * stored_size + (std::uint64_t{64} << 10);
}

/// Where the table and its checksum end, given the first kHeaderBytes bytes.
/// Errors: kInvalidInput, kUnsupported; "byte N: ...".
[[nodiscard]] Result<std::size_t> head_size(std::span<const std::byte> header);

/// Decodes and checks header, table and their checksum; `head` has head_size() bytes. All offsets
/// and sizes in the result fit together and fit the file size.
[[nodiscard]] Result<ContainerTable> decode_head(std::span<const std::byte> head);

/// The head as bytes, checksum included.
[[nodiscard]] std::vector<std::byte> encode_head(const ContainerTable& table);

/// A fault of a chunk: "chunk 'VERT': ...".
[[nodiscard]] tl::unexpected<Error> bad_chunk(const ChunkInfo& chunk, const std::string& fault);

}  // namespace container
}  // namespace varifold
