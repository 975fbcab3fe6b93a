#include <varifold/strip/cache_order.h>

#include <varifold/base/math.h>
#include <algorithm>
#include <cassert>
#include <numeric>

namespace varifold {

std::span<const std::uint32_t> CacheOrder::order(std::span<const std::uint16_t> corners,
                                                 std::uint32_t vertex_count) {
  assert(cache_size_ >= 3 && corners.size() % 3 == 0);
  corners_ = corners;
  vertex_count_ = vertex_count;
  const std::size_t triangles = corners.size() / 3;
  find_triangles_of_vertices();
  // 0 is long ago: counting begins beyond the size of the cache.
  brought_in_.assign(vertex_count, 0);
  taken_.assign(triangles, 0);
  order_.clear();
  visited_.clear();
  misses_ = cache_size_;
  cursor_ = 0;
  for (std::uint32_t vertex = next_vertex(); vertex != kNone; vertex = next_vertex())
    take_fan(vertex);
  if (!has_fewer_misses()) std::iota(order_.begin(), order_.end(), 0u);
  return order_;
}

void CacheOrder::find_triangles_of_vertices() {
  first_.assign(vertex_count_ + 1, 0);
  for (const std::uint16_t v : corners_) ++first_[v + 1u];
  live_.assign(first_.begin() + 1, first_.end());
  for (std::uint32_t v = 0; v < vertex_count_; ++v) first_[v + 1] += first_[v];
  triangles_.resize(corners_.size());
  // From the back, so that each vertex has its triangles in their order.
  for (std::size_t i = corners_.size(); i-- > 0;) {
    const std::uint16_t v = corners_[i];
    triangles_[--first_[v + 1u]] = static_cast<std::uint32_t>(i / 3);
  }
  // first_[v + 1] is where v begins now.
}

void CacheOrder::take_fan(std::uint32_t vertex) {
  fan_begin_ = static_cast<std::uint32_t>(visited_.size());
  const std::uint32_t begin = first_[vertex + 1];
  const auto end = vertex + 2 < first_.size() ? first_[vertex + 2]
                                              : static_cast<std::uint32_t>(triangles_.size());
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::uint32_t triangle = triangles_[i];
    if (taken_[triangle] != 0) continue;
    taken_[triangle] = 1;
    order_.push_back(triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = corners_[3 * std::size_t{triangle} + k];
      visited_.push_back(v);
      --live_[v];
      use(v);
    }
  }
}

std::uint32_t CacheOrder::next_vertex() {
  // Of the last fan, the one that is about to leave the cache, if its own fan comes in time.
  std::uint32_t best = kNone, most = 0;
  for (std::size_t i = fan_begin_; i < visited_.size(); ++i) {
    const std::uint32_t v = visited_[i];
    if (live_[v] == 0) continue;
    const std::uint32_t now = urgency(v);
    if (best == kNone || now > most) best = v, most = now;
  }
  if (best != kNone) return best;
  // A dead end: back along the way, then wherever there is something left.
  while (!visited_.empty()) {
    const std::uint32_t v = visited_.back();
    if (live_[v] != 0) return v;
    visited_.pop_back();
  }
  while (cursor_ < vertex_count_ && live_[cursor_] == 0) ++cursor_;
  return cursor_ < vertex_count_ ? cursor_ : kNone;
}

// Whether the new order has fewer than the old one.
bool CacheOrder::has_fewer_misses() {
  const std::uint32_t new_misses = misses_ - cache_size_;
  brought_in_.assign(vertex_count_, 0);
  misses_ = cache_size_;
  for (const std::uint16_t v : corners_) use(v);
  return new_misses < misses_ - cache_size_;
}

void CacheOrder::reorder(std::span<std::uint16_t> corners, std::uint32_t vertex_count) {
  copy_.assign(corners.begin(), corners.end());
  const auto ordered = order(copy_, vertex_count);
  for (std::size_t t = 0; t < ordered.size(); ++t)
    std::copy_n(&copy_[3 * std::size_t{ordered[t]}], 3, &corners[3 * t]);
}

void order_for_vertex_cache(std::span<std::uint16_t> corners, std::uint32_t vertex_count,
                            std::uint32_t cache_size) {
  CacheOrder(cache_size).reorder(corners, vertex_count);
}

}  // namespace varifold
