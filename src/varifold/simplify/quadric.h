// The error quadric of a vertex, with its origin at the vertex itself.
//
// Based on: [GarlandHeckbert1997] section 5, area-weighted as in [GarlandHeckbert1998].
// Differs: single precision about the vertex' own position instead of double about one origin. All
//   planes of a fresh vertex pass through it, so it starts as a plain 3x3 matrix.
#pragma once

#include <varifold/base/math.h>
#include <algorithm>

namespace varifold {

/// Q(d) = d'Ad + 2 b'd + c for an offset d from the quadric's origin.
struct Quadric {
  float xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;  ///< A, symmetric
  Vec3 b{0};
  float c = 0;

  /// Adds weight * (distance to the plane through the origin with unit normal `n`)^2.
  void add_plane(const Vec3& n, float weight) {
    const Vec3 wn = weight * n;
    xx += wn.x * n.x, yy += wn.y * n.y, zz += wn.z * n.z;
    xy += wn.x * n.y, xz += wn.x * n.z, yz += wn.y * n.z;
  }

  /// Adds weight * (distance to the origin)^2.
  void add_point(float weight) { xx += weight, yy += weight, zz += weight; }

  [[nodiscard]] Vec3 times(const Vec3& d) const {
    return {xx * d.x + xy * d.y + xz * d.z, xy * d.x + yy * d.y + yz * d.z,
            xz * d.x + yz * d.y + zz * d.z};
  }

  /// The weighted squared error at offset `d`; rounding below zero is cut off.
  [[nodiscard]] float at(const Vec3& d) const {
    const Vec3 r = times(d) + 2.0f * b;
    return std::max(0.0f, r.x * d.x + r.y * d.y + r.z * d.z + c);
  }

  /// The same function about an origin that lies at offset `d` from this one.
  [[nodiscard]] Quadric moved_by(const Vec3& d) const {
    Quadric q = *this;
    q.b = b + times(d);
    q.c = at(d);
    return q;
  }

  Quadric& operator+=(const Quadric& q) {
    xx += q.xx, yy += q.yy, zz += q.zz, xy += q.xy, xz += q.xz, yz += q.yz;
    b += q.b, c += q.c;
    return *this;
  }
};

}  // namespace varifold
