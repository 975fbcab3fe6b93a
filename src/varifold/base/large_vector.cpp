#include <varifold/base/large_vector.h>

#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace varifold {

namespace {

constexpr std::size_t kLine = 64;
constexpr std::size_t kHugePage = std::size_t{2} << 20;
constexpr std::size_t kLarge = 2 * kHugePage;

}  // namespace

void* allocate_large(std::size_t bytes) {
  const std::size_t alignment = bytes >= kLarge ? kHugePage : kLine;
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, rounded < bytes || rounded == 0 ? bytes : rounded);
  if (!memory && bytes > 0) throw std::bad_alloc();
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  if (bytes >= kLarge) (void)madvise(memory, rounded, MADV_HUGEPAGE);  // only a hint
#endif
  return memory;
}

void free_large(void* memory) noexcept { std::free(memory); }

}  // namespace varifold
