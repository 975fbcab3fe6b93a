#include <varifold/measure/closest_point.h>
#include <algorithm>

namespace varifold {

DVec3 closest_on_segment(const DVec3& p, const DVec3& a, const DVec3& b) {
  const DVec3 ab = b - a;
  const double along = glm::dot(p - a, ab);
  const double length = glm::dot(ab, ab);
  if (!(along > 0)) return a;
  return along >= length ? b : a + (along / length) * ab;
}

DVec3 closest_on_triangle(const DVec3& p, const DVec3& a, const DVec3& b, const DVec3& c) {
  const DVec3 ab = b - a, ac = c - a, ap = p - a;
  const DVec3 normal = glm::cross(ab, ac);
  const double area = glm::dot(normal, normal);

  // Barycentric weights of the projection of p, times the area.
  const double weight_b = glm::dot(glm::cross(ap, ac), normal);
  const double weight_c = glm::dot(glm::cross(ab, ap), normal);
  const double weight_a = area - weight_b - weight_c;
  const bool is_flat = area > 0;
  if (is_flat && weight_a >= 0 && weight_b >= 0 && weight_c >= 0)
    return a + (weight_b * ab + weight_c * ac) / area;

  // Outside: the closest point is on an edge that has p on its outer side.
  DVec3 best = a;
  double best_square = glm::dot(ap, ap);
  const auto try_edge = [&](const DVec3& from, const DVec3& to) {
    const DVec3 q = closest_on_segment(p, from, to);
    const double square = glm::dot(q - p, q - p);
    if (!(square < best_square)) return;
    best_square = square;
    best = q;
  };
  if (!is_flat || weight_c <= 0) try_edge(a, b);
  if (!is_flat || weight_a <= 0) try_edge(b, c);
  if (!is_flat || weight_b <= 0) try_edge(c, a);
  return best;
}

}  // namespace varifold
