// A vector for large arrays that are walked at random: on huge pages where the system has them.
#pragma once

#include <cstddef>
#include <vector>

namespace varifold {

/// Memory for `bytes`, aligned to at least 64; beyond a few megabytes aligned to, and marked for,
/// huge pages, which saves most page faults and address translations, and given back to the system
/// as soon as it is freed. Throws std::bad_alloc.
[[nodiscard]] void* allocate_large(std::size_t bytes);
/// `bytes` as it was allocated.
void free_large(void* memory, std::size_t bytes) noexcept;

/// Gives what small allocations have left free back to the system, where the system has a way.
void release_free_memory();

template <class T>
struct LargeAllocator {
  using value_type = T;
  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>&) {}  // NOLINT: allocators convert
  T* allocate(std::size_t count) { return static_cast<T*>(allocate_large(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t count) noexcept { free_large(memory, count * sizeof(T)); }
  friend bool operator==(const LargeAllocator&, const LargeAllocator&) { return true; }
};

template <class T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

}  // namespace varifold
