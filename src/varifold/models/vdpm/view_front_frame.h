// What one call of ViewFront::adapt() carries along, and keys that need no question.
#pragma once

#include <varifold/models/vdpm/view_front.h>
#include <chrono>
#include <cstdint>

namespace varifold {

// What one call of adapt() carries along.
struct ViewFront::Frame {
  ActiveSurface& surface;
  FrontGeomorphs* morphs;  // or null
  const FrontLimits& limits;
  std::uint32_t max_triangles;
  FrontStatistics statistics;
  std::chrono::steady_clock::time_point end;

  [[nodiscard]] std::uint32_t triangle_count() const {
    return morphs != nullptr ? morphs->triangle_count() : surface.triangle_count();
  }
  // Whether another change is within the limits.
  [[nodiscard]] bool may_change() {
    const std::uint32_t changes = statistics.splits + statistics.collapses;
    if (changes >= limits.max_changes) return false;
    if (limits.max_microseconds <= 0) return true;
    if (changes % 16 == 0) in_time = std::chrono::steady_clock::now() < end;
    return in_time;
  }
  bool in_time = true;
};

}  // namespace varifold
