#include <varifold/io/container_stream.h>

#include <varifold/base/bytes.h>
#include <zstd.h>
#include <algorithm>

namespace varifold {

using container::bad_chunk;

/// One zstd frame that is decoded piece by piece.
struct ContainerStream::Decompressor {
  Decompressor() : context(ZSTD_createDCtx()) {
    ZSTD_DCtx_setParameter(context, ZSTD_d_windowLogMax, container::kWindowLog);
  }
  ~Decompressor() { ZSTD_freeDCtx(context); }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  ZSTD_DCtx* context;
  bool frame_ended = false;
};

ContainerStream::ContainerStream() = default;
ContainerStream::~ContainerStream() = default;
ContainerStream::ContainerStream(ContainerStream&&) noexcept = default;
ContainerStream& ContainerStream::operator=(ContainerStream&&) noexcept = default;

Result<std::vector<StreamEvent>> ContainerStream::push(std::span<const std::byte> piece) {
  Events events;
  const std::size_t first = current_;
  const std::size_t first_size = first < raw_.size() ? raw_[first].size() : 0;
  while (!error_ && !piece.empty()) {
    auto done = advance(piece, events);
    if (done) done = complete_empty_chunks(events);
    if (!done) error_ = std::move(done.error());
  }
  if (error_) return tl::unexpected(*error_);
  const std::size_t size = current_ < raw_.size() ? raw_[current_].size() : 0;
  if (size > (current_ == first ? first_size : 0))
    events.push_back({StreamEvent::Kind::kGrown, current_});
  return events;
}

Result<void> ContainerStream::finish() const {
  if (error_) return tl::unexpected(*error_);
  if (!is_complete()) return bad("the file ends too early");
  return {};
}

tl::unexpected<Error> ContainerStream::bad(const std::string& fault) const {
  return fail(ErrorKind::kInvalidInput, "byte " + std::to_string(position_) + ": " + fault);
}

/// Takes the next part of the file, of one sort, off the piece.
Result<void> ContainerStream::advance(std::span<const std::byte>& piece, Events& events) {
  if (!has_table_) return advance_head(piece, events);
  if (position_ == table_.file_size) return bad("bytes after the end");
  if (current_ == table_.chunks.size() || position_ < table_.chunks[current_].offset)
    return advance_padding(piece);
  return advance_chunk(piece, events);
}

Result<void> ContainerStream::advance_head(std::span<const std::byte>& piece, Events& events) {
  std::size_t wanted = container::kHeaderBytes;
  if (head_.size() >= wanted) {
    const auto size = container::head_size(head_);
    if (!size) return tl::unexpected(size.error());
    wanted = *size;
  }
  const std::size_t taken = std::min(piece.size(), wanted - head_.size());
  head_.insert(head_.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(taken));
  piece = piece.subspan(taken);
  position_ += taken;
  if (head_.size() < wanted) return {};
  if (wanted == container::kHeaderBytes) {
    const auto size = container::head_size(head_);
    return size ? Result<void>() : tl::unexpected(size.error());
  }

  auto table = container::decode_head(head_);
  if (!table) return tl::unexpected(std::move(table.error()));
  table_ = std::move(*table);
  has_table_ = true;
  raw_.resize(table_.chunks.size());
  events.push_back({StreamEvent::Kind::kTable, 0});
  return {};
}

Result<void> ContainerStream::advance_padding(std::span<const std::byte>& piece) {
  const std::uint64_t end =
      current_ < table_.chunks.size() ? table_.chunks[current_].offset : table_.file_size;
  for (; position_ < end && !piece.empty(); piece = piece.subspan(1), ++position_)
    if (piece.front() != std::byte{0}) return bad("padding is not zero");
  return {};
}

Result<void> ContainerStream::advance_chunk(std::span<const std::byte>& piece, Events& events) {
  const ChunkInfo& chunk = table_.chunks[current_];
  const std::uint64_t left = chunk.offset + chunk.stored_size - position_;
  const auto stored = piece.first(std::min<std::uint64_t>(piece.size(), left));
  piece = piece.subspan(stored.size());
  position_ += stored.size();
  checksum_.add(stored);
  if (!chunk.compressed) {
    raw_[current_].insert(raw_[current_].end(), stored.begin(), stored.end());
  } else if (auto done = decompress(stored); !done) {
    return done;
  }
  return stored.size() == left ? complete_chunk(events) : Result<void>();
}

Result<void> ContainerStream::decompress(std::span<const std::byte> stored) {
  const ChunkInfo& chunk = table_.chunks[current_];
  if (!decompressor_) decompressor_ = std::make_unique<Decompressor>();
  std::vector<std::byte>& raw = raw_[current_];
  ZSTD_inBuffer input{stored.data(), stored.size(), 0};
  bool is_output_full = true;
  while (input.pos < input.size || is_output_full) {
    // One byte more than the chunk may have, so that a surplus shows.
    const std::uint64_t room = chunk.raw_size + 1 - raw.size();
    const std::size_t used = raw.size();
    raw.resize(used + std::min<std::uint64_t>(room, ZSTD_DStreamOutSize()));
    ZSTD_outBuffer output{raw.data() + used, raw.size() - used, 0};
    const std::size_t before = input.pos;
    const std::size_t left = ZSTD_decompressStream(decompressor_->context, &output, &input);
    raw.resize(used + output.pos);
    if (ZSTD_isError(left) || raw.size() > chunk.raw_size)
      return bad_chunk(chunk, "cannot be decompressed");
    decompressor_->frame_ended = left == 0;
    is_output_full = output.pos == output.size;
    if (input.pos == before && output.pos == 0) break;
  }
  return {};
}

/// Chunks of no bytes are complete as soon as their place is reached.
Result<void> ContainerStream::complete_empty_chunks(Events& events) {
  while (current_ < table_.chunks.size() && table_.chunks[current_].stored_size == 0 &&
         position_ == table_.chunks[current_].offset)
    if (auto done = complete_chunk(events); !done) return done;
  return {};
}

Result<void> ContainerStream::complete_chunk(Events& events) {
  const ChunkInfo& chunk = table_.chunks[current_];
  const bool is_whole = !decompressor_ || decompressor_->frame_ended;
  if (checksum_.value() != chunk.checksum) return bad_chunk(chunk, "wrong checksum");
  if (!is_whole || raw_[current_].size() != chunk.raw_size)
    return bad_chunk(chunk, "cannot be decompressed");
  events.push_back({StreamEvent::Kind::kComplete, current_});
  ++current_;
  checksum_.reset();
  decompressor_.reset();
  return {};
}

}  // namespace varifold
