#include <varifold/io/output_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

namespace varifold {
namespace {

constexpr mode_t kPermissions = 0666;  // less the umask

/// A name that no other file of this folder has, unless it is left from a process of the same id.
std::filesystem::path temporary_name(const std::filesystem::path& target) {
  static std::atomic<unsigned> counter{0};
  return target.parent_path() /
         (".varifold-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp");
}

std::filesystem::path folder_of(const std::filesystem::path& target) {
  return target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
}

/// Flushes the file to the disk; 0 or the errno. Some file systems cannot, which is no fault.
int flush(int file) {
  if (::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP || errno == EROFS) return 0;
  return errno;
}

}  // namespace

Result<OutputFile> OutputFile::create(const std::filesystem::path& path) {
  OutputFile result(path);
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return result.failure(EISDIR);
  result.direct_ = path == "/dev/stdout" || (exists && !S_ISREG(status.st_mode));
  if (!result.direct_ && exists) {
    if (::access(path.c_str(), W_OK) != 0) return result.failure(errno);
    std::error_code error;
    const auto followed = std::filesystem::canonical(path, error);
    if (!error) result.target_ = followed;
  }
  if (const int error = result.direct_ ? result.open_directly() : result.open_temporary())
    return result.failure(error);
  if (!result.direct_ && exists) (void)::fchmod(result.file_, status.st_mode & 07777);
  return result;
}

int OutputFile::open_directly() {
  // Opening /dev/stdout anew would write from the start of a file that the shell redirects to.
  file_ = path_ == "/dev/stdout" ? ::dup(STDOUT_FILENO)
                                 : ::open(path_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  return file_ < 0 ? errno : 0;
}

int OutputFile::open_temporary() {
#ifdef O_TMPFILE
  // A nameless file vanishes by itself, even when the process is killed; /proc gives it a name.
  if (::access("/proc/self/fd", X_OK) == 0)
    file_ = ::open(folder_of(target_).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, kPermissions);
  if (file_ >= 0) return 0;
#endif
  do {
    temporary_ = temporary_name(target_);
    file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kPermissions);
  } while (file_ < 0 && errno == EEXIST);
  if (file_ >= 0) return 0;
  temporary_.clear();
  return errno;
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      file_(std::exchange(other.file_, -1)),
      direct_(other.direct_) {}

OutputFile::~OutputFile() {
  if (file_ >= 0) ::close(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Result<void> OutputFile::write(std::span<const std::byte> bytes) {
  constexpr std::size_t kLargestPiece = std::size_t{1} << 30;
  while (!bytes.empty()) {
    const std::size_t piece = bytes.size() < kLargestPiece ? bytes.size() : kLargestPiece;
    const ssize_t written = ::write(file_, bytes.data(), piece);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return failure(errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

Result<void> OutputFile::commit() {
  if (!direct_) {
    if (const int error = flush(file_)) return failure(error);
    if (temporary_.empty())
      if (const int error = link_temporary()) return failure(error);
  }
  // Network file systems report a full disk as late as here.
  if (::close(std::exchange(file_, -1)) != 0) return failure(errno);
  if (direct_) return {};
  if (const int error = move_into_place()) return failure(error);
  return {};
}

int OutputFile::link_temporary() {
  const std::string source = "/proc/self/fd/" + std::to_string(file_);
  while (true) {
    const std::filesystem::path name = temporary_name(target_);
    if (::linkat(AT_FDCWD, source.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      temporary_ = name;
      return 0;
    }
    if (errno != EEXIST) return errno;
  }
}

int OutputFile::move_into_place() {
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) return errno;
  temporary_.clear();
  const int folder = ::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    (void)flush(folder);
    ::close(folder);
  }
  return 0;
}

tl::unexpected<Error> OutputFile::failure(int error) const {
  return fail(ErrorKind::kFailed, path_.string() + ": " + std::strerror(error));
}

Result<void> write_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  auto file = OutputFile::create(path);
  if (!file) return tl::unexpected(file.error());
  if (auto written = file->write(bytes); !written) return written;
  return file->commit();
}

}  // namespace varifold
