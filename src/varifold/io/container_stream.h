// A .vfm file that arrives piece by piece, from a pipe or over a network.
#pragma once

#include <varifold/base/checksum.h>
#include <varifold/base/result.h>
#include <varifold/io/container_table.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace varifold {

/// What a piece of the file has brought.
struct StreamEvent {
  enum class Kind {
    kTable,    ///< kind() and table() are there now
    kGrown,    ///< more bytes of a chunk are there, decompressed but not verified yet
    kComplete  ///< a chunk is there as a whole, and verified
  };
  Kind kind = Kind::kTable;
  std::size_t chunk = 0;  ///< index in table().chunks; 0 for kTable
};

/// Reads a .vfm file in one pass. Holds the bytes of chunks until they are taken, and never more
/// memory than what has arrived justifies (a window of 8 MiB for compressed chunks aside).
///
/// What kGrown shows has not been verified: a decoder that works on it must stand wrong bytes, and
/// take back its result when the checksum turns out wrong.
class ContainerStream {
 public:
  ContainerStream();
  ~ContainerStream();
  ContainerStream(ContainerStream&&) noexcept;
  ContainerStream& operator=(ContainerStream&&) noexcept;

  /// Takes the next piece of the file, of any size. Returns what it brought, in order; a chunk
  /// that grew and was completed by this piece has only the latter event. O(bytes).
  /// Errors: as Container's, also for bytes after the end. After an error all calls return it.
  [[nodiscard]] Result<std::vector<StreamEvent>> push(std::span<const std::byte> piece);

  /// To be called when no more bytes come. Error: kInvalidInput where the file is not complete.
  [[nodiscard]] Result<void> finish() const;

  [[nodiscard]] bool has_table() const { return has_table_; }
  [[nodiscard]] const ContainerTable& table() const { return table_; }
  [[nodiscard]] bool is_complete() const { return has_table_ && position_ == table_.file_size; }
  /// Bytes of the file that have been taken.
  [[nodiscard]] std::uint64_t position() const { return position_; }

  /// The decompressed bytes of a chunk that are there so far; valid until the next push().
  [[nodiscard]] std::span<const std::byte> bytes(std::size_t chunk) const { return raw_[chunk]; }
  /// Hands over the bytes of a complete chunk.
  [[nodiscard]] std::vector<std::byte> take(std::size_t chunk) { return std::move(raw_[chunk]); }

 private:
  struct Decompressor;
  using Events = std::vector<StreamEvent>;
  [[nodiscard]] Result<void> advance(std::span<const std::byte>& piece, Events& events);
  [[nodiscard]] Result<void> advance_head(std::span<const std::byte>& piece, Events& events);
  [[nodiscard]] Result<void> advance_padding(std::span<const std::byte>& piece);
  [[nodiscard]] Result<void> advance_chunk(std::span<const std::byte>& piece, Events& events);
  [[nodiscard]] Result<void> decompress(std::span<const std::byte> stored);
  [[nodiscard]] Result<void> complete_chunk(Events& events);
  [[nodiscard]] Result<void> complete_empty_chunks(Events& events);
  [[nodiscard]] tl::unexpected<Error> bad(const std::string& fault) const;

  std::uint64_t position_ = 0;
  std::vector<std::byte> head_;
  bool has_table_ = false;
  ContainerTable table_;
  std::size_t current_ = 0;  ///< the first chunk that is not complete
  std::vector<std::vector<std::byte>> raw_;
  ChecksumStream checksum_;
  std::unique_ptr<Decompressor> decompressor_;
  std::optional<Error> error_;
};

}  // namespace varifold
