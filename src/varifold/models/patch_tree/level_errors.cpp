#include <varifold/models/patch_tree/level_errors.h>

#include <varifold/base/parallel.h>
#include <varifold/simplify/closest_on_triangle.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace varifold {

namespace {

// How many further stars a sample may walk through to a nearer place.
constexpr int kMaxSteps = 3;
// A place whose weight at the star's centre is below this is on the star's rim.
constexpr float kRim = 1e-4f;

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
    const bool at_rim = found.along_b + found.along_c >= 1 - kRim;
    best.next = !at_rim ? kNone : found.along_b > found.along_c ? ring[i].neighbor : next;
  }
  return best;
}

}  // namespace

LevelErrors::LevelErrors(const WorkingSurface& surface, int threads, const ShapeTable* shapes)
    : surface_(surface),
      shapes_(shapes),
      threads_(threads),
      carrier_(surface.point_count()),
      squared_(surface.point_count(), 0.0f),
      greatest_(surface.point_count(), 0.0f),
      first_(surface.point_count() + 1),
      samples_(surface.point_count()) {
  std::iota(carrier_.begin(), carrier_.end(), 0u);
}

void LevelErrors::measure(std::span<const std::pair<std::uint32_t, std::uint32_t>> went,
                          std::span<const std::uint32_t> live) {
  // first_ serves as the table of where points went.
  for (const std::uint32_t p : live) first_[p] = p;
  for (const auto& [from, onto] : went) first_[from] = onto;
  for (std::uint32_t& carrier : carrier_) carrier = first_[carrier];
  sort_by_carrier();
  parallel_for(threads_, live.size(), 256, [&](std::size_t begin, std::size_t end) {
    Scratch scratch;
    for (const std::uint32_t p : live.subspan(begin, end - begin)) measure_carried(p, scratch);
  });
}

void LevelErrors::sort_by_carrier() {
  std::fill(first_.begin(), first_.end(), 0u);
  const auto count = static_cast<std::uint32_t>(carrier_.size());
  for (std::uint32_t s = 0; s < count; ++s) ++first_[carrier_[s]];
  std::uint32_t sum = 0;
  for (std::uint32_t& first : first_) first = sum += first;
  for (std::uint32_t s = count; s-- > 0;) samples_[--first_[carrier_[s]]] = s;
}

void LevelErrors::find_star(std::uint32_t point, Scratch& scratch) const {
  scratch.star.clear();
  scratch.rim.clear();
  const RingEntry* ring = surface_.ring(point);
  const std::uint32_t size = surface_.points[point].ring_size;
  for (std::uint32_t i = 0; i < size; ++i) {
    if (ring[i].face == kNone) continue;
    const std::uint32_t m = ring[i].neighbor, n = ring[i + 1 == size ? 0 : i + 1].neighbor;
    scratch.star.push_back({i,
                            {surface_.points[point].position, surface_.points[m].position,
                             surface_.points[n].position}});
    scratch.rim.push_back(m);
    scratch.rim.push_back(n);
  }
}

// What a point carries at its own place is on the surface.
void LevelErrors::measure_carried(std::uint32_t point, Scratch& scratch) {
  greatest_[point] = 0;
  const std::span<const std::uint32_t> samples(samples_.data() + first_[point],
                                               samples_.data() + first_[point + 1]);
  if (samples.size() < 2 && (samples.empty() || samples.front() == point)) {
    squared_[point] = 0;
    return;
  }
  if (shapes_) {
    NearestInShapes nearest(*shapes_);
    for (const std::uint32_t s : samples) measure_in_shapes(s, nearest, scratch);
  } else {
    find_star(point, scratch);
    for (std::size_t i = 0; i < samples.size(); i += NearestBatch::kSize)
      measure_batch(samples.subspan(i, std::min(NearestBatch::kSize, samples.size() - i)), scratch);
  }
  float greatest = 0;
  for (const std::uint32_t s : samples) greatest = std::max(greatest, squared_[s]);
  squared_[point] = 0;
  greatest_[point] = std::sqrt(greatest);
}

// As measure_batch() and walk_on() do it, with the greatest distance of any blend.
void LevelErrors::measure_in_shapes(std::uint32_t sample, NearestInShapes& nearest,
                                    Scratch& scratch) {
  const std::span<const Vec3> at = shapes_->of(sample);
  std::uint32_t center = carrier_[sample];
  squared_[sample] = std::numeric_limits<float>::infinity();
  for (int step = 0; step <= kMaxSteps && center != kNone; ++step) {
    find_star(center, scratch);
    scratch.corners.clear();
    for (std::size_t i = 0; i < scratch.star.size(); ++i)
      scratch.corners.push_back({center, scratch.rim[2 * i], scratch.rim[2 * i + 1]});
    if (scratch.corners.empty()) scratch.corners.push_back({center, center, center});
    const std::size_t found = nearest.find(at, scratch.corners);
    const float distance = nearest.greatest_way(at);
    if (!(distance * distance < squared_[sample])) return;
    squared_[sample] = distance * distance;
    carrier_[sample] = center;
    const Vec2 weights = nearest.weights_at_rest();
    if (weights.x + weights.y < 1 - kRim) return;
    center = scratch.corners[found][weights.x > weights.y ? 1 : 2];
  }
}

void LevelErrors::measure_batch(std::span<const std::uint32_t> samples, const Scratch& scratch) {
  if (samples.size() < 3 || scratch.star.empty()) {
    for (const std::uint32_t s : samples) {
      const StarNearest nearest =
          nearest_in_star(surface_, carrier_[s], surface_.points[s].position);
      squared_[s] = nearest.squared;
      if (nearest.next == kNone) continue;
      walk_on(s, nearest.next);
    }
    return;
  }
  NearestBatch batch;
  for (std::size_t i = 0; i < NearestBatch::kSize; ++i) {
    const Vec3& p = surface_.points[samples[std::min(i, samples.size() - 1)]].position;
    batch.x[i] = p.x, batch.y[i] = p.y, batch.z[i] = p.z;
  }
  star_triangles::find_nearest(scratch.star, batch);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 way(batch.way_x[i], batch.way_y[i], batch.way_z[i]);
    const auto found = static_cast<std::size_t>(batch.found[i]);
    squared_[samples[i]] = glm::dot(way, way);
    const auto& [center, m, n] = scratch.star[found].corners;
    const Vec3 place = surface_.points[samples[i]].position + way;
    const Vec3 normal = glm::cross(m - center, n - center);
    const Vec3 to_m = m - place, to_n = n - place;
    if (!(glm::dot(glm::cross(to_m, to_n), normal) <= kRim * glm::dot(normal, normal))) continue;
    const bool nearer_m = glm::dot(to_m, to_m) < glm::dot(to_n, to_n);
    walk_on(samples[i], scratch.rim[2 * found + (nearer_m ? 0 : 1)]);
  }
}

// From the rim of a star to the star of a neighbour, as long as that is nearer.
void LevelErrors::walk_on(std::uint32_t sample, std::uint32_t next) {
  const Vec3 place = surface_.points[sample].position;
  for (int i = 0; i < kMaxSteps && next != kNone && squared_[sample] > 0; ++i) {
    const StarNearest nearest = nearest_in_star(surface_, next, place);
    if (!(nearest.squared < squared_[sample])) return;
    squared_[sample] = nearest.squared;
    carrier_[sample] = next;
    next = nearest.next;
  }
}

}  // namespace varifold
