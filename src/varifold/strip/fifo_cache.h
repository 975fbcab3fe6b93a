// A first-in first-out cache of vertices, simulated.
#pragma once

#include <cstdint>
#include <vector>

namespace varifold {

/// A vertex is in the cache as long as fewer than `size` others were brought in after it, which a
/// counter of misses tells without a queue. O(1) an access.
class FifoCache {
 public:
  FifoCache(std::uint32_t vertex_count, std::uint32_t size)
      : size_(size), misses_(size), brought_in_(vertex_count, 0) {}

  [[nodiscard]] bool holds(std::uint32_t vertex) const {
    return misses_ - brought_in_[vertex] < size_;
  }
  /// holds() after so many more misses of other vertices.
  [[nodiscard]] bool would_hold(std::uint32_t vertex, std::uint64_t more_misses) const {
    return misses_ + more_misses - brought_in_[vertex] < size_;
  }
  /// Whether it was a miss, after which the vertex is in.
  bool use(std::uint32_t vertex) {
    if (holds(vertex)) return false;
    brought_in_[vertex] = ++misses_;
    return true;
  }
  [[nodiscard]] std::uint64_t misses() const { return misses_ - size_; }
  [[nodiscard]] bool was_used(std::uint32_t vertex) const { return brought_in_[vertex] > size_; }

 private:
  std::uint64_t size_;
  std::uint64_t misses_;                   // begins at size_, so that 0 is long ago
  std::vector<std::uint64_t> brought_in_;  // per vertex, misses_ when it came in
};

}  // namespace varifold
