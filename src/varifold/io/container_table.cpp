#include <varifold/io/container_table.h>

#include <varifold/base/bytes.h>
#include <varifold/base/checksum.h>
#include <algorithm>
#include <array>

namespace varifold {
namespace {

// As PNG's signature: a byte that is not ASCII, and line ends that a transfer as text would change.
constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'V', 'F', 'M', '\r', '\n', 0x1a, '\n'};

constexpr std::uint32_t kCompressedFlag = 1;

tl::unexpected<Error> bad(std::uint64_t position, const std::string& fault,
                          ErrorKind kind = ErrorKind::kInvalidInput) {
  return fail(kind, "byte " + std::to_string(position) + ": " + fault);
}

}  // namespace

std::string fourcc_name(std::uint32_t code) {
  std::string text = "'....'";
  bool prints = true;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto c = static_cast<char>(code >> (8 * i) & 0xff);
    prints = prints && c > ' ' && c < 0x7f;
    text[i + 1] = c;
  }
  if (prints) return text;
  constexpr std::string_view kDigits = "0123456789abcdef";
  text = "0x";
  for (int shift = 28; shift >= 0; shift -= 4) text += kDigits[code >> shift & 15];
  return text;
}

namespace container {

tl::unexpected<Error> bad_chunk(const ChunkInfo& chunk, const std::string& fault) {
  return fail(ErrorKind::kInvalidInput, "chunk " + fourcc_name(chunk.tag) + ": " + fault);
}

Result<std::size_t> head_size(std::span<const std::byte> header) {
  const auto magic = std::as_bytes(std::span(kMagic));
  const std::size_t compared = std::min(header.size(), magic.size());
  if (!std::equal(magic.begin(), magic.begin() + static_cast<std::ptrdiff_t>(compared),
                  header.begin()))
    return bad(0, "not a .vfm file");
  if (header.size() < kHeaderBytes) return bad(header.size(), "the file ends in the header");
  const auto version = load<std::uint32_t>(header.data() + 8);
  if (version != kVersion)
    return bad(8, "version " + std::to_string(version) + " is not known", ErrorKind::kUnsupported);
  const auto count = load<std::uint32_t>(header.data() + 16);
  if (count > kMostChunks) return bad(16, std::to_string(count) + " chunks are too many");
  if (load<std::uint32_t>(header.data() + 20) != 0) return bad(20, "reserved bytes are not zero");
  return kHeaderBytes + kEntryBytes * count + kChecksumBytes;
}

namespace {

/// Chunks stand in the order of the table, each at the first aligned place after the one before.
Result<ChunkInfo> decode_entry(std::span<const std::byte> head, std::size_t at,
                               std::uint64_t expected_offset, std::uint64_t file_size) {
  const std::byte* const entry = head.data() + at;
  ChunkInfo chunk;
  chunk.tag = load<std::uint32_t>(entry);
  const auto flags = load<std::uint32_t>(entry + 4);
  chunk.compressed = (flags & kCompressedFlag) != 0;
  chunk.offset = load<std::uint64_t>(entry + 8);
  chunk.stored_size = load<std::uint64_t>(entry + 16);
  chunk.raw_size = load<std::uint64_t>(entry + 24);
  chunk.checksum = load<std::uint64_t>(entry + 32);
  if ((flags & ~kCompressedFlag) != 0) return bad(at + 4, "unknown flags", ErrorKind::kUnsupported);
  if (chunk.offset != expected_offset)
    return bad(at + 8, "chunk " + fourcc_name(chunk.tag) + " is not where the one before ends");
  if (chunk.offset > file_size || chunk.stored_size > file_size - chunk.offset)
    return bad(at + 16, "chunk " + fourcc_name(chunk.tag) + " goes past the end of the file");
  const bool sane = chunk.compressed ? chunk.raw_size <= most_raw_bytes(chunk.stored_size)
                                     : chunk.raw_size == chunk.stored_size;
  if (!sane)
    return bad(at + 24, "chunk " + fourcc_name(chunk.tag) + " cannot have " +
                            std::to_string(chunk.raw_size) + " bytes");
  return chunk;
}

}  // namespace

Result<ContainerTable> decode_head(std::span<const std::byte> head) {
  const std::size_t table_end = head.size() - kChecksumBytes;
  if (load<std::uint64_t>(head.data() + table_end) != checksum(head.first(table_end)))
    return bad(table_end, "wrong checksum of the header");
  ContainerTable table;
  table.kind = load<std::uint32_t>(head.data() + 12);
  table.file_size = load<std::uint64_t>(head.data() + 24);
  // No sum of sizes can overflow below this.
  if (table.file_size >> 62 != 0) return bad(24, "the file size is not believable");
  std::uint64_t end = aligned(head.size());
  for (std::size_t at = kHeaderBytes; at < table_end; at += kEntryBytes) {
    auto chunk = decode_entry(head, at, end, table.file_size);
    if (!chunk) return tl::unexpected(std::move(chunk.error()));
    for (const ChunkInfo& other : table.chunks)
      if (other.tag == chunk->tag) return bad(at, "chunk " + fourcc_name(chunk->tag) + " twice");
    end = aligned(chunk->offset + chunk->stored_size);
    table.chunks.push_back(*chunk);
  }
  if (end != table.file_size)
    return bad(24, "a file size of " + std::to_string(table.file_size) +
                       " bytes does not fit the chunks, which end at " + std::to_string(end));
  return table;
}

std::vector<std::byte> encode_head(const ContainerTable& table) {
  std::vector<std::byte> head;
  for (const std::uint8_t byte : kMagic) append_little(head, byte);
  append_little(head, kVersion);
  append_little(head, table.kind);
  append_little(head, static_cast<std::uint32_t>(table.chunks.size()));
  append_little(head, std::uint32_t{0});
  append_little(head, table.file_size);
  for (const ChunkInfo& chunk : table.chunks) {
    append_little(head, chunk.tag);
    append_little(head, chunk.compressed ? kCompressedFlag : 0);
    append_little(head, chunk.offset);
    append_little(head, chunk.stored_size);
    append_little(head, chunk.raw_size);
    append_little(head, chunk.checksum);
  }
  append_little(head, checksum(head));
  return head;
}

}  // namespace container
}  // namespace varifold
