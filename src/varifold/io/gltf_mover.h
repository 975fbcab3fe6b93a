// How the vertices of an instance come into the world.
#pragma once

#include <varifold/base/math.h>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

namespace varifold::gltf {

/// Moves points and directions; leaves them as they are, bit by bit, where it is the identity.
class Mover {
 public:
  explicit Mover(const glm::dmat4& transform = glm::dmat4(1))
      : matrix_(transform), is_identity_(transform == glm::dmat4(1)) {
    const glm::dmat3 linear(transform);
    // The matrix of cofactors is the inverse transpose times the determinant, and always exists.
    for (int i = 0; i < 3; ++i)
      cofactors_[i] = glm::cross(linear[(i + 1) % 3], linear[(i + 2) % 3]);
    mirrors_ = glm::dot(linear[0], cofactors_[0]) < 0;
    if (mirrors_) cofactors_ = -cofactors_;
  }
  [[nodiscard]] bool mirrors() const { return mirrors_; }
  [[nodiscard]] Vec3 point(const Vec3& p) const {
    return is_identity_ ? p : Vec3(matrix_ * glm::dvec4(p, 1));
  }
  [[nodiscard]] Vec3 normal(const Vec3& n) const {
    return is_identity_ ? n : normalize_or_zero(Vec3(glm::normalize(cofactors_ * DVec3(n))));
  }
  /// What becomes of a change of places.
  [[nodiscard]] Vec3 offset(const Vec3& d) const {
    return is_identity_ ? d : Vec3(glm::dmat3(matrix_) * DVec3(d));
  }
  /// What becomes of a change of the normal n, in the measure that makes normal(n) a unit.
  [[nodiscard]] Vec3 normal_offset(const Vec3& n, const Vec3& d) const {
    if (is_identity_) return d;
    const double length = glm::length(cofactors_ * DVec3(n));
    return length > 0 ? Vec3(cofactors_ * DVec3(d) / length) : Vec3(0);
  }

 private:
  glm::dmat4 matrix_;
  glm::dmat3 cofactors_{1};
  bool is_identity_;
  bool mirrors_ = false;
};

}  // namespace varifold::gltf
