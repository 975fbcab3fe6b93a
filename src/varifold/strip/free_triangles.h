// The triangles that no strip has yet, and where the next strip should begin.
#pragma once

#include <varifold/strip/strip_paths.h>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace varifold {

/// Which triangles are free, and how many free neighbours each has. O(1) amortised a triangle.
class FreeTriangles {
 public:
  /// Triangles with `taken` set are not free. `paths` must outlive this.
  FreeTriangles(const StripPaths& paths, std::vector<std::uint8_t> taken)
      : paths_(paths), taken_(std::move(taken)), neighbors_(paths.triangle_count(), 0) {
    for (std::uint32_t t = paths_.triangle_count(); t-- > 0;) {
      if (taken_[t]) continue;
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) neighbors_[t] += is_free(h) ? 1 : 0;
      starts_[neighbors_[t]].push_back(t);
    }
  }

  /// Whether there is a free triangle across a half-edge.
  [[nodiscard]] bool is_free(std::uint32_t half_edge) const {
    const std::uint32_t other = paths_.across(half_edge);
    return other != kNone && !taken_[other / 3];
  }
  /// Free neighbours of a free triangle.
  [[nodiscard]] std::uint32_t neighbors(std::uint32_t triangle) const {
    return neighbors_[triangle];
  }

  void take(std::uint32_t triangle) {
    taken_[triangle] = 1;
    for (std::uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
      if (!is_free(h)) continue;
      const std::uint32_t other = paths_.across(h) / 3;
      starts_[--neighbors_[other]].push_back(other);
    }
  }

  /// A free triangle with the fewest free neighbours, of those the one that lost one last; kNone
  /// where all are taken. The caller takes it, or another one, before it asks again.
  [[nodiscard]] std::uint32_t fewest_neighbors() {
    for (std::uint32_t count = 0; count < starts_.size(); ++count) {
      auto& starts = starts_[count];
      while (!starts.empty()) {
        const std::uint32_t t = starts.back();
        if (!taken_[t] && neighbors_[t] == count) return t;
        starts.pop_back();
      }
    }
    return kNone;
  }

 private:
  const StripPaths& paths_;
  std::vector<std::uint8_t> taken_;
  std::vector<std::uint8_t> neighbors_;
  std::array<std::vector<std::uint32_t>, 4> starts_;  // by free neighbours when pushed
};

}  // namespace varifold
