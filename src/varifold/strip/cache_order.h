// An order of triangles for the cache of transformed vertices.
//
// Based on: [SanderNehabBarczak2007] section 3.
// Differs: for short lists of 16-bit corners that are ordered one after the other, so its memory is
//   kept; an order that is no better than the one given is not taken; no clusters against overdraw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Orders the triangles of one list after the other. Its memory grows with the largest list; a list
/// no larger than one before allocates nothing.
class CacheOrder {
 public:
  /// For a first-in first-out cache of `cache_size` >= 3 vertices. Larger caches gain as well.
  explicit CacheOrder(std::uint32_t cache_size = 16) : cache_size_(cache_size) {}

  /// The triangles in their new order, by number; valid until the next call. Where the order given
  /// has no more misses than the new one would, it stays. `corners` holds three per triangle, all
  /// less than `vertex_count`. O(corners + vertices).
  [[nodiscard]] std::span<const std::uint32_t> order(std::span<const std::uint16_t> corners,
                                                     std::uint32_t vertex_count);

  /// Brings the triangles into that order, each with its corners as they were.
  void reorder(std::span<std::uint16_t> corners, std::uint32_t vertex_count);

 private:
  void find_triangles_of_vertices();
  void take_fan(std::uint32_t vertex);
  [[nodiscard]] std::uint32_t next_vertex();
  [[nodiscard]] bool has_fewer_misses();
  // Of a vertex that still has triangles: how long it has been in the cache, if it will still be
  // there when its fan is through; 0 else.
  [[nodiscard]] std::uint32_t urgency(std::uint32_t vertex) const {
    const std::uint32_t age = misses_ - brought_in_[vertex];
    return age + 2 * live_[vertex] <= cache_size_ ? age : 0;
  }
  void use(std::uint32_t vertex) {
    if (misses_ - brought_in_[vertex] >= cache_size_) brought_in_[vertex] = ++misses_;
  }

  std::uint32_t cache_size_;
  std::span<const std::uint16_t> corners_;
  std::uint32_t vertex_count_ = 0;
  std::vector<std::uint32_t> first_, triangles_;  // those of each vertex
  std::vector<std::uint32_t> live_;               // per vertex: its triangles not yet taken
  std::vector<std::uint32_t> brought_in_;         // per vertex: misses_ when it came in
  std::vector<std::uint8_t> taken_;               // per triangle
  std::vector<std::uint32_t> order_, visited_;    // visited_: corners as they were taken
  std::vector<std::uint16_t> copy_;
  std::uint32_t misses_ = 0, fan_begin_ = 0, cursor_ = 0;
};

/// CacheOrder::reorder for a single list.
void order_for_vertex_cache(std::span<std::uint16_t> corners, std::uint32_t vertex_count,
                            std::uint32_t cache_size = 16);

}  // namespace varifold
