#include <varifold/morph/sphere_point.h>

namespace varifold {
namespace {

__extension__ using Int128 = __int128;

// a . (u x v), where u and v are differences: at most 2^41, 2^42 and 2^42, so that each product is
// below 2^125 and the sum of six, by Hadamard's bound, too.
double exact_determinant(const SpherePoint& a, const SpherePoint& u, const SpherePoint& v) {
  const Int128 x = Int128{u.y} * v.z - Int128{u.z} * v.y;
  const Int128 y = Int128{u.z} * v.x - Int128{u.x} * v.z;
  const Int128 z = Int128{u.x} * v.y - Int128{u.y} * v.x;
  return static_cast<double>(x * a.x + y * a.y + z * a.z);
}

SpherePoint difference(const SpherePoint& p, const SpherePoint& q) {
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}

}  // namespace

double determinant(const SpherePoint& a, const SpherePoint& b, const SpherePoint& c) {
  // Differences are exact, and small where the triangle is: so is the bound of the rounding.
  const SpherePoint u = difference(b, a), v = difference(c, a);
  const DVec3 du(u.x, u.y, u.z), dv(v.x, v.y, v.z), da(a.x, a.y, a.z);
  const double xp = du.y * dv.z, xq = du.z * dv.y;
  const double yp = du.z * dv.x, yq = du.x * dv.z;
  const double zp = du.x * dv.y, zq = du.y * dv.x;
  const double value = (xp - xq) * da.x + (yp - yq) * da.y + (zp - zq) * da.z;
  const double magnitude = (std::abs(xp) + std::abs(xq)) * std::abs(da.x) +
                           (std::abs(yp) + std::abs(yq)) * std::abs(da.y) +
                           (std::abs(zp) + std::abs(zq)) * std::abs(da.z);
  // Seven roundings on the longest way, so the error is below 8 * 2^-53 of the magnitude; the
  // factor asks for 12 digits more or less, which the exact value has.
  constexpr double kTrusted = 0x1.0p-12;
  if (std::abs(value) > kTrusted * magnitude) return value;
  return exact_determinant(a, u, v);
}

}  // namespace varifold
