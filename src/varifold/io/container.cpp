#include <varifold/io/container.h>

#include <varifold/base/bytes.h>
#include <varifold/base/checksum.h>
#include <zstd.h>
#include <algorithm>
#include <array>

namespace varifold {
namespace {

constexpr int kCompressionLevel = 9;

/// The bytes compressed, or nothing where that does not pay or could not be read back.
std::optional<std::vector<std::byte>> compressed(const std::vector<std::byte>& raw) {
  std::vector<std::byte> stored(ZSTD_compressBound(raw.size()));
  const std::size_t size =
      ZSTD_compress(stored.data(), stored.size(), raw.data(), raw.size(), kCompressionLevel);
  if (ZSTD_isError(size) || size >= raw.size() || raw.size() > container::most_raw_bytes(size))
    return std::nullopt;
  stored.resize(size);
  return stored;
}

bool is_zero(std::span<const std::byte> bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

}  // namespace

Result<std::vector<std::byte>> encode_container(std::uint32_t kind, std::span<const Chunk> chunks) {
  if (chunks.size() > container::kMostChunks)
    return fail(ErrorKind::kFailed, std::to_string(chunks.size()) + " chunks are too many");
  for (std::size_t i = 0; i < chunks.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (chunks[i].tag == chunks[j].tag)
        return fail(ErrorKind::kFailed, "chunk " + fourcc_name(chunks[i].tag) + " twice");

  ContainerTable table;
  table.kind = kind;
  std::vector<std::optional<std::vector<std::byte>>> packed;
  std::uint64_t end = container::aligned(container::kHeaderBytes + container::kChecksumBytes +
                                         container::kEntryBytes * chunks.size());
  for (const Chunk& chunk : chunks) {
    packed.push_back(chunk.compress ? compressed(chunk.bytes) : std::nullopt);
    const std::vector<std::byte>& stored = packed.back() ? *packed.back() : chunk.bytes;
    table.chunks.push_back({chunk.tag, packed.back().has_value(), end, stored.size(),
                            chunk.bytes.size(), checksum(stored)});
    end = container::aligned(end + stored.size());
  }
  table.file_size = end;

  std::vector<std::byte> file = container::encode_head(table);
  file.reserve(end);
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    file.resize(table.chunks[i].offset);
    const std::vector<std::byte>& stored = packed[i] ? *packed[i] : chunks[i].bytes;
    file.insert(file.end(), stored.begin(), stored.end());
  }
  file.resize(end);
  return file;
}

Result<Container> Container::open(const std::filesystem::path& path) {
  auto mapping = MappedFile::open(path);
  if (!mapping) return tl::unexpected(std::move(mapping.error()));
  auto result = parse(mapping->bytes());
  if (!result) return fail_in(path.string(), std::move(result.error()));
  result->mapping_ = std::move(*mapping);
  // The bytes of a pipe have moved with the object that holds them.
  result->file_ = result->mapping_->bytes();
  result->name_ = path.string();
  return result;
}

Result<Container> Container::parse(std::span<const std::byte> file) {
  const auto head_bytes =
      container::head_size(file.first(std::min(file.size(), container::kHeaderBytes)));
  if (!head_bytes) return tl::unexpected(head_bytes.error());
  const auto place = [&](std::uint64_t position) { return "byte " + std::to_string(position); };
  if (*head_bytes > file.size())
    return fail(ErrorKind::kInvalidInput,
                place(file.size()) + ": the file ends in the chunk table");
  auto table = container::decode_head(file.first(*head_bytes));
  if (!table) return tl::unexpected(std::move(table.error()));
  if (table->file_size != file.size())
    return fail(ErrorKind::kInvalidInput, place(file.size()) + ": the file should have " +
                                              std::to_string(table->file_size) +
                                              " bytes, but has " + std::to_string(file.size()));

  std::uint64_t end = *head_bytes;
  for (std::size_t i = 0; i <= table->chunks.size(); ++i) {
    const std::uint64_t next =
        i < table->chunks.size() ? table->chunks[i].offset : table->file_size;
    if (!is_zero(file.subspan(end, next - end)))
      return fail(ErrorKind::kInvalidInput, place(end) + ": padding is not zero");
    if (i < table->chunks.size()) end = next + table->chunks[i].stored_size;
  }
  Container result;
  result.file_ = file;
  result.table_ = std::move(*table);
  result.states_.resize(result.table_.chunks.size());
  return result;
}

bool Container::has(std::uint32_t tag) const {
  return std::any_of(table_.chunks.begin(), table_.chunks.end(),
                     [&](const ChunkInfo& chunk) { return chunk.tag == tag; });
}

Result<std::span<const std::byte>> Container::find(std::uint32_t tag) {
  for (std::size_t i = 0; i < table_.chunks.size(); ++i) {
    if (table_.chunks[i].tag != tag) continue;
    auto bytes = load_chunk(i);
    if (!bytes && !name_.empty()) return fail_in(name_, std::move(bytes.error()));
    return bytes;
  }
  auto missing = fail(ErrorKind::kInvalidInput, "no chunk " + fourcc_name(tag));
  return name_.empty() ? missing : fail_in(name_, std::move(missing.value()));
}

Result<std::span<const std::byte>> Container::load_chunk(std::size_t index) {
  const ChunkInfo& chunk = table_.chunks[index];
  State& state = states_[index];
  const auto stored = file_.subspan(chunk.offset, chunk.stored_size);
  if (!state.is_verified) {
    if (checksum(stored) != chunk.checksum) return container::bad_chunk(chunk, "wrong checksum");
    if (chunk.compressed) {
      state.raw.resize(chunk.raw_size);
      const std::size_t size =
          ZSTD_decompress(state.raw.data(), state.raw.size(), stored.data(), stored.size());
      if (ZSTD_isError(size) || size != chunk.raw_size) {
        state.raw = {};
        return container::bad_chunk(chunk, "cannot be decompressed");
      }
    }
    state.is_verified = true;
  }
  return chunk.compressed ? std::span<const std::byte>(state.raw) : stored;
}

Result<void> Container::verify() {
  for (const ChunkInfo& chunk : table_.chunks)
    if (auto bytes = find(chunk.tag); !bytes) return tl::unexpected(std::move(bytes.error()));
  return {};
}

}  // namespace varifold
