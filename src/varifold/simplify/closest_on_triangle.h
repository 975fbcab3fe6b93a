// The point of a triangle nearest to the origin.
#pragma once

#include <varifold/base/math.h>

namespace varifold {

/// A point of the triangle (a, b, c): a + along_b (b - a) + along_c (c - a).
struct TrianglePoint {
  Vec3 position;
  float along_b, along_c;
};

/// Nearest to the origin, by the region of the triangle's plane that it lies in [Ericson2005,
/// 5.1.5]. Subtract the place in question from the corners first: then coordinates may be large.
inline TrianglePoint closest_on_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const float d1 = -glm::dot(ab, a), d2 = -glm::dot(ac, a);
  if (d1 <= 0 && d2 <= 0) return {a, 0, 0};
  const float d3 = -glm::dot(ab, b), d4 = -glm::dot(ac, b);
  if (d3 >= 0 && d4 <= d3) return {b, 1, 0};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, d1 / (d1 - d3), 0};
  const float d5 = -glm::dot(ab, c), d6 = -glm::dot(ac, c);
  if (d6 >= 0 && d5 <= d6) return {c, 0, 1};
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, 0, d2 / (d2 - d6)};
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const float t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {b + t * (c - b), 1 - t, t};
  }
  const float inverse = 1 / (va + vb + vc);
  return {a + vb * inverse * ab + vc * inverse * ac, vb * inverse, vc * inverse};
}

}  // namespace varifold
