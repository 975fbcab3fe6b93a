#include <varifold/base/large_vector.h>

#include <cstdint>
#include <cstdlib>
#include <new>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace varifold {

namespace {

constexpr std::size_t kLine = 64;

// A size that does not fit any more after rounding is too much for any system.
std::size_t rounded_up(std::size_t bytes, std::size_t unit) {
  const std::size_t rounded = (bytes + unit - 1) / unit * unit;
  if (rounded < bytes) throw std::bad_alloc();
  return rounded;
}

void* allocate_lines(std::size_t bytes) {
  void* memory = std::aligned_alloc(kLine, rounded_up(bytes == 0 ? 1 : bytes, kLine));
  if (!memory) throw std::bad_alloc();
  return memory;
}

#if defined(__linux__)

constexpr std::size_t kHugePage = std::size_t{2} << 20;
constexpr std::size_t kLarge = 2 * kHugePage;

// Maps one page more than needed and gives back what stands out of whole pages.
void* map_pages(std::size_t size) {
  const std::size_t whole = rounded_up(size + 1, kHugePage);
  void* mapped = mmap(nullptr, whole, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  char* begin = static_cast<char*>(mapped);
  const std::size_t before =
      (kHugePage - reinterpret_cast<std::uintptr_t>(begin) % kHugePage) % kHugePage;
  if (before > 0) (void)munmap(begin, before);
  if (whole - before > size) (void)munmap(begin + before + size, whole - before - size);
  (void)madvise(begin + before, size, MADV_HUGEPAGE);  // only a hint
  return begin + before;
}

#endif

}  // namespace

void release_free_memory() {
#if defined(__GLIBC__)
  (void)malloc_trim(0);
#endif
}

void* allocate_large(std::size_t bytes) {
#if defined(__linux__)
  if (bytes >= kLarge) return map_pages(rounded_up(bytes, kHugePage));
#endif
  return allocate_lines(bytes);
}

void free_large(void* memory, std::size_t bytes) noexcept {
#if defined(__linux__)
  if (bytes >= kLarge) {
    (void)munmap(memory, (bytes + kHugePage - 1) / kHugePage * kHugePage);
    return;
  }
#endif
  (void)bytes;
  std::free(memory);
}

}  // namespace varifold
