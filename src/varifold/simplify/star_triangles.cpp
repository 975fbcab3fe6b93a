#include <varifold/simplify/star_triangles.h>

#include <cmath>
#include <limits>

namespace varifold::star_triangles {

namespace {

struct Lane {
  float x, y, z;
};
inline Lane operator-(const Lane& a, const Lane& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Lane operator+(const Lane& a, const Lane& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Lane operator*(float s, const Lane& a) { return {s * a.x, s * a.y, s * a.z}; }
inline float dot(const Lane& a, const Lane& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Lane choose(bool first, const Lane& a, const Lane& b) {
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}

// closest_on_triangle() with all regions at once and no branches: the same operations.
inline Lane closest(const Lane& a, const Lane& b, const Lane& c) {
  const Lane ab = b - a, ac = c - a;
  const float d1 = -dot(ab, a), d2 = -dot(ac, a), d3 = -dot(ab, b), d4 = -dot(ac, b);
  const float d5 = -dot(ab, c), d6 = -dot(ac, c);
  const float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  const float inverse = 1 / (va + vb + vc);
  Lane point = a + vb * inverse * ab + vc * inverse * ac;
  // The regions in turn, the last first, so that an earlier one has the last word.
  const bool on_bc = (va <= 0) & (d4 - d3 >= 0) & (d5 - d6 >= 0);
  point = choose(on_bc, b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), point);
  const bool on_ac = (vb <= 0) & (d2 >= 0) & (d6 <= 0);
  point = choose(on_ac, a + d2 / (d2 - d6) * ac, point);
  point = choose((d6 >= 0) & (d5 <= d6), c, point);
  const bool on_ab = (vc <= 0) & (d1 >= 0) & (d3 <= 0);
  point = choose(on_ab, a + d1 / (d1 - d3) * ab, point);
  point = choose((d3 >= 0) & (d4 <= d3), b, point);
  return choose((d1 <= 0) & (d2 <= 0), a, point);
}

__attribute__((always_inline)) inline void find_lanes(std::span<const StarTriangle> triangles,
                                                      NearestBatch& __restrict batch) {
  alignas(32) float least[NearestBatch::kSize];
  for (std::size_t i = 0; i < NearestBatch::kSize; ++i) {
    least[i] = std::numeric_limits<float>::infinity();
    batch.found[i] = 0;
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::array<Vec3, 3>& corners = triangles[t].corners;
    const Lane a{corners[0].x, corners[0].y, corners[0].z};
    const Lane b{corners[1].x, corners[1].y, corners[1].z};
    const Lane c{corners[2].x, corners[2].y, corners[2].z};
    const auto number = static_cast<std::int32_t>(t);
    for (std::size_t i = 0; i < NearestBatch::kSize; ++i) {
      const Lane p{batch.x[i], batch.y[i], batch.z[i]};
      const Lane point = closest(a - p, b - p, c - p);
      const float order = dot(point, point);
      const bool is_nearer = (order < least[i]) | (number == 0);
      least[i] = is_nearer ? order : least[i];
      batch.found[i] = is_nearer ? number : batch.found[i];
      batch.way_x[i] = is_nearer ? point.x : batch.way_x[i];
      batch.way_y[i] = is_nearer ? point.y : batch.way_y[i];
      batch.way_z[i] = is_nearer ? point.z : batch.way_z[i];
    }
  }
}

}  // namespace

void find_nearest_plain(std::span<const StarTriangle> triangles, NearestBatch& batch) {
  find_lanes(triangles, batch);
}

#if defined(__x86_64__)

namespace {

__attribute__((target("avx2"))) void find_nearest_avx2(std::span<const StarTriangle> triangles,
                                                       NearestBatch& batch) {
  find_lanes(triangles, batch);
}
const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;

}  // namespace

void find_nearest(std::span<const StarTriangle> triangles, NearestBatch& batch) {
  kHasAvx2 ? find_nearest_avx2(triangles, batch) : find_lanes(triangles, batch);
}

#else

void find_nearest(std::span<const StarTriangle> triangles, NearestBatch& batch) {
  find_lanes(triangles, batch);
}

#endif

}  // namespace varifold::star_triangles
