// Files that appear whole or not at all.
#pragma once

#include <varifold/base/result.h>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace varifold {

/// A file that is being written. The bytes go to a nameless (or, where the file system has none, a
/// temporary) file in the same folder; commit() puts it in the place of `path` in one step, so that
/// a reader sees the old content or the new one, never a part. Destroyed without commit(), nothing
/// remains. Devices, pipes and /dev/stdout are written directly.
///
/// Errors are kFailed, with the path first.
class OutputFile {
 public:
  [[nodiscard]] static Result<OutputFile> create(const std::filesystem::path& path);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();

  /// Appends the bytes, all of them or an error.
  [[nodiscard]] Result<void> write(std::span<const std::byte> bytes);

  /// Flushes to the disk and puts the file in its place. Only once, as the last call.
  [[nodiscard]] Result<void> commit();

 private:
  explicit OutputFile(const std::filesystem::path& path) : path_(path), target_(path) {}
  [[nodiscard]] int open_directly();
  [[nodiscard]] int open_temporary();
  [[nodiscard]] int link_temporary();
  [[nodiscard]] int move_into_place();
  [[nodiscard]] tl::unexpected<Error> failure(int error) const;

  std::filesystem::path path_;    ///< as the caller named it, for messages
  std::filesystem::path target_;  ///< the same with symbolic links followed
  std::filesystem::path temporary_;
  int file_ = -1;
  bool direct_ = false;
};

/// Writes a whole file by way of OutputFile.
[[nodiscard]] Result<void> write_file(const std::filesystem::path& path,
                                      std::span<const std::byte> bytes);

}  // namespace varifold
