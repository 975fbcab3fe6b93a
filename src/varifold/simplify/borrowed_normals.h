// Normals for points whose faces have no area: those of what is around them.
#pragma once

#include <varifold/simplify/packed_normal.h>
#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <utility>
#include <vector>

namespace varifold {

/// Gives every point without a normal the mean of those of its neighbours, round by round until all
/// have one or none can get one. A part of a mesh may be squashed in one of its shapes; faces there
/// would be free to turn over otherwise. `normal_of(point)` is a reference to a packed normal.
/// O(points + rounds * points without).
template <class NormalOf>
void borrow_normals(const WorkingSurface& surface, const NormalOf& normal_of) {
  const std::uint32_t none = pack_normal(Vec3(0));
  std::vector<std::uint32_t> without;
  for (std::uint32_t point = 0; point < surface.point_count(); ++point)
    if (normal_of(point) == none) without.push_back(point);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found;  // points and their normals
  do {
    found.clear();
    for (const std::uint32_t point : without) {
      if (normal_of(point) != none) continue;
      const RingEntry* const ring = surface.ring(point);
      Vec3 sum(0);
      for (std::uint32_t i = 0; i < surface.points[point].ring_size; ++i)
        sum += unpack_normal(normal_of(ring[i].neighbor));
      if (const std::uint32_t normal = pack_normal(sum); normal != none)
        found.emplace_back(point, normal);
    }
    for (const auto& [point, normal] : found) normal_of(point) = normal;
  } while (!found.empty());
}

}  // namespace varifold
