#include <varifold/models/patch_tree/level_errors.h>

#include <varifold/base/parallel.h>
#include <varifold/simplify/closest_on_triangle.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace varifold {

namespace {

// How many stars a sample may walk through to the nearest place.
constexpr int kMaxStars = 4;

struct StarNearest {
  float squared = std::numeric_limits<float>::infinity();
  std::uint32_t next = kNone;  // the neighbour whose star may be nearer
};

StarNearest nearest_in_star(const WorkingSurface& surface, std::uint32_t point, const Vec3& p) {
  StarNearest best;
  const RingEntry* ring = surface.ring(point);
  const std::uint32_t size = surface.points[point].ring_size;
  const Vec3 a = surface.points[point].position - p;
  if (size == 0) best.squared = glm::dot(a, a);
  for (std::uint32_t i = 0; i < size; ++i) {
    if (ring[i].face == kNone) continue;
    const std::uint32_t next = ring[i + 1 == size ? 0 : i + 1].neighbor;
    const TrianglePoint found = closest_on_triangle(
        a, surface.points[ring[i].neighbor].position - p, surface.points[next].position - p);
    const float squared = glm::dot(found.position, found.position);
    if (!(squared < best.squared)) continue;
    best.squared = squared;
    // On the far side of the triangle the way may lead on.
    const bool at_rim = found.along_b + found.along_c >= 1 - 1e-5f;
    best.next = !at_rim ? kNone : found.along_b > found.along_c ? ring[i].neighbor : next;
  }
  return best;
}

}  // namespace

LevelErrors::LevelErrors(const WorkingSurface& surface, int threads)
    : surface_(surface),
      threads_(threads),
      step_(surface.point_count(), 0.0f),
      greatest_(surface.point_count(), 0.0f),
      sample_(surface.point_count()) {
  std::iota(sample_.begin(), sample_.end(), 0u);
}

float LevelErrors::squared_distance(std::uint32_t sample, std::uint32_t point) const {
  const Vec3 place = surface_.points[sample].position;
  StarNearest nearest = nearest_in_star(surface_, point, place);
  for (int i = 1; i < kMaxStars && nearest.next != kNone && nearest.squared > 0; ++i) {
    const StarNearest other = nearest_in_star(surface_, nearest.next, place);
    if (!(other.squared < nearest.squared)) break;
    nearest = other;
  }
  return nearest.squared;
}

void LevelErrors::carry(std::uint32_t point, std::uint32_t sample, float squared) {
  const float distance = std::sqrt(squared);
  if (distance <= greatest_[point]) return;
  greatest_[point] = distance;
  sample_[point] = sample;
}

void LevelErrors::measure(std::span<const std::pair<std::uint32_t, std::uint32_t>> went,
                          std::span<const std::uint32_t> live) {
  std::vector<float> carried(went.size());
  parallel_for(threads_, went.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto [from, onto] = went[i];
      step_[from] = squared_distance(from, onto);
      carried[i] = greatest_[from] > 0 ? squared_distance(sample_[from], onto) : 0.0f;
    }
  });
  parallel_for(threads_, live.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (const std::uint32_t p : live.subspan(begin, end - begin)) {
      step_[p] = 0;
      if (greatest_[p] > 0) greatest_[p] = std::sqrt(squared_distance(sample_[p], p));
    }
  });
  for (std::size_t i = 0; i < went.size(); ++i) {
    const auto [from, onto] = went[i];
    carry(onto, from, step_[from]);
    carry(onto, sample_[from], carried[i]);
  }
}

}  // namespace varifold
