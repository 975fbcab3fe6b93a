// The vector types of the public interface, and the few helpers that GLM lacks.
#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>

namespace varifold {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using DVec3 = glm::dvec3;
using Color = glm::u8vec4;  ///< red, green, blue, alpha; linear alpha, sRGB colour as in the file

inline constexpr std::uint32_t kNone = 0xffffffffu;  ///< "no such vertex, face, step, ..."

/// Axis-aligned box; empty (lower > upper) until a point is added.
struct Box {
  Vec3 lower{std::numeric_limits<float>::max()};
  Vec3 upper{std::numeric_limits<float>::lowest()};

  void add(const Vec3& p) {
    lower = Vec3(p.x < lower.x ? p.x : lower.x, p.y < lower.y ? p.y : lower.y,
                 p.z < lower.z ? p.z : lower.z);
    upper = Vec3(p.x > upper.x ? p.x : upper.x, p.y > upper.y ? p.y : upper.y,
                 p.z > upper.z ? p.z : upper.z);
  }
  [[nodiscard]] bool empty() const { return lower.x > upper.x; }
  [[nodiscard]] Vec3 center() const { return empty() ? Vec3(0) : 0.5f * (lower + upper); }
  [[nodiscard]] float diagonal() const { return empty() ? 0.0f : glm::length(upper - lower); }
};

/// Normalised, or the zero vector where the length is zero or not finite.
[[nodiscard]] inline Vec3 normalize_or_zero(const Vec3& v) {
  const float length = glm::length(v);
  return length > 0 && length < std::numeric_limits<float>::infinity() ? v / length : Vec3(0);
}

}  // namespace varifold
