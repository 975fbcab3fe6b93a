// Based on: [GarlandHeckbert1997] section 4 (the minimum of a quadric).
#include <varifold/simplify/edge_placement.h>

#include <algorithm>
#include <cmath>

namespace varifold {

namespace {

// A symmetric 3x3 system in double: quadrics of nearly flat regions are nearly singular.
struct Symmetric {
  double xx, yy, zz, xy, xz, yz;

  [[nodiscard]] DVec3 times(const DVec3& d) const {
    return {xx * d.x + xy * d.y + xz * d.z, xy * d.x + yy * d.y + yz * d.z,
            xz * d.x + yz * d.y + zz * d.z};
  }
  [[nodiscard]] bool solve(const DVec3& right, DVec3& x) const {
    const double cx = yy * zz - yz * yz, cy = xz * yz - xy * zz, cz = xy * yz - xz * yy;
    const double determinant = xx * cx + xy * cy + xz * cz;
    if (!(determinant > 0)) return false;
    const double dxx = xx * zz - xz * xz, dyy = xx * yy - xy * xy, dyz = xy * xz - xx * yz;
    x = DVec3(cx * right.x + cy * right.y + cz * right.z,
              cy * right.x + dxx * right.y + dyz * right.z,
              cz * right.x + dyz * right.y + dyy * right.z) /
        determinant;
    return true;
  }
};

Symmetric matrix_of(const Quadric& q) { return {q.xx, q.yy, q.zz, q.xy, q.xz, q.yz}; }

// Both quadrics are about their own points and have no linear part there; `x` is about `from`.
EdgePlacement placement_at(const PlacementEdge& edge, const DVec3& x) {
  const DVec3 y = x - DVec3(edge.onto - edge.from);
  const double error = glm::dot(x, matrix_of(edge.from_quadric.quadric).times(x)) +
                       glm::dot(y, matrix_of(edge.onto_quadric.quadric).times(y));
  return {edge.from + Vec3(x), static_cast<float>(std::max(0.0, error)),
          edge.from_quadric.weight + edge.onto_quadric.weight};
}

}  // namespace

EdgePlacement placement_at_end(const PlacementEdge& edge) {
  EdgePlacement result = placement_at(edge, edge.onto - edge.from);
  result.position = edge.onto;
  return result;
}

EdgePlacement place_edge(const PlacementEdge& edge) {
  const DVec3 d = edge.onto - edge.from;
  const Symmetric a = matrix_of(edge.from_quadric.quadric);
  const Symmetric b = matrix_of(edge.onto_quadric.quadric);
  const Symmetric sum{a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
  DVec3 x(0);
  const bool solved = sum.solve(b.times(d), x);
  // A minimum far from the edge comes from planes that are nearly parallel.
  const DVec3 from_middle = x - 0.5 * d;
  if (!solved || !(glm::dot(from_middle, from_middle) < 4 * glm::dot(d, d))) x = 0.5 * d;
  return placement_at(edge, x);
}

Refusal test_placed_collapse(WorkingSurface& surface, const PlacedCollapse& collapse,
                             const LegalityOptions& options) {
  const auto [from, onto, position, normal] = collapse;
  if (const Refusal refusal = test_connectivity(surface, from, onto, options);
      refusal != Refusal::kLegal)
    return refusal;
  if (const Refusal refusal = test_faces(surface, {from, onto, position, normal}, options);
      refusal != Refusal::kLegal)
    return refusal;
  return test_faces(surface, {onto, from, position, normal}, options);
}

}  // namespace varifold
