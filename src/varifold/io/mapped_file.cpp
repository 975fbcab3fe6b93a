#include <varifold/io/mapped_file.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cerrno>
#include <cstring>
#include <utility>

namespace varifold {
namespace {

/// Closes a file descriptor at the end of a scope.
struct Descriptor {
  int value;
  ~Descriptor() {
    if (value >= 0) ::close(value);
  }
};

tl::unexpected<Error> unreadable(const std::filesystem::path& path, int error) {
  return fail(ErrorKind::kUnreadable, path.string() + ": " + std::strerror(error));
}

/// Reads to the end of a pipe or device; 0 or the errno.
int read_all(int file, std::vector<std::byte>& buffer) {
  constexpr std::size_t kFirstPiece = 1 << 16;
  std::size_t used = 0;
  while (true) {
    if (used == buffer.size()) buffer.resize(used < kFirstPiece ? kFirstPiece : 2 * used);
    const ssize_t got = ::read(file, buffer.data() + used, buffer.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno;
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
  }
  buffer.resize(used);
  return 0;
}

}  // namespace

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.value < 0) return unreadable(path, errno);
  struct stat status {};
  if (::fstat(file.value, &status) != 0) return unreadable(path, errno);
  if (S_ISDIR(status.st_mode)) return unreadable(path, EISDIR);

  // Some of these, such as /dev/zero, have no end.
  const bool is_device =
      S_ISBLK(status.st_mode) || (S_ISCHR(status.st_mode) && ::isatty(file.value) == 0);
  if (is_device) return fail(ErrorKind::kUnreadable, path.string() + ": Is a device");

  MappedFile result;
  if (S_ISREG(status.st_mode) && status.st_size > 0) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* const mapping = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.value, 0);
    if (mapping != MAP_FAILED) {
      ::madvise(mapping, size, MADV_SEQUENTIAL);
      result.mapping_ = mapping;
      result.mapping_size_ = size;
      return result;
    }
  }
  // Not mappable, or a file of /proc that claims to be empty: read it.
  if (const int error = read_all(file.value, result.buffer_)) return unreadable(path, error);
  return result;
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : mapping_(std::exchange(other.mapping_, nullptr)),
      mapping_size_(std::exchange(other.mapping_size_, 0)),
      buffer_(std::move(other.buffer_)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  if (this == &other) return *this;
  unmap();
  mapping_ = std::exchange(other.mapping_, nullptr);
  mapping_size_ = std::exchange(other.mapping_size_, 0);
  buffer_ = std::move(other.buffer_);
  return *this;
}

MappedFile::~MappedFile() { unmap(); }

void MappedFile::unmap() {
  if (mapping_) ::munmap(mapping_, mapping_size_);
}

}  // namespace varifold
