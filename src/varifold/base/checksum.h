// Checksums of byte spans: XXH3, 64 bits (xxhash.com), as stored in .vfm files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace varifold {

[[nodiscard]] std::uint64_t checksum(std::span<const std::byte> bytes);

/// The same for bytes that arrive in pieces.
class ChecksumStream {
 public:
  ChecksumStream();
  ~ChecksumStream();
  ChecksumStream(ChecksumStream&&) noexcept;
  ChecksumStream& operator=(ChecksumStream&&) noexcept;

  void add(std::span<const std::byte> bytes);
  /// Of all bytes that have been added.
  [[nodiscard]] std::uint64_t value() const;
  /// Begins anew.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace varifold
