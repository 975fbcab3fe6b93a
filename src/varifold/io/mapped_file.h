// Read-only view of a file's bytes.
#pragma once

#include <varifold/base/result.h>
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace varifold {

/// The bytes of a file, mapped into memory; pipes, terminals and standard input (/dev/stdin) are
/// read to their end instead. Move-only; the bytes live as long as the object.
///
/// A mapped file must not be truncated by another program while it is in use: the system answers
/// reads past its new end with a signal.
class MappedFile {
 public:
  /// Errors: kUnreadable, with the path first, where the file cannot be opened or read, or is a
  /// folder or a device.
  [[nodiscard]] static Result<MappedFile> open(const std::filesystem::path& path);

  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  ~MappedFile();

  [[nodiscard]] std::span<const std::byte> bytes() const {
    if (mapping_) return {static_cast<const std::byte*>(mapping_), mapping_size_};
    return buffer_;
  }

 private:
  MappedFile() = default;
  void unmap();

  void* mapping_ = nullptr;
  std::size_t mapping_size_ = 0;
  std::vector<std::byte> buffer_;
};

}  // namespace varifold
