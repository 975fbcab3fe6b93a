#include <varifold/view/frustum.h>

#include <varifold/base/angle.h>

namespace varifold {
namespace {

Plane through(const Vec3& point, const Vec3& normal) {
  const Vec3 unit = glm::normalize(normal);
  return {unit, -glm::dot(unit, point)};
}

/// The corner of a box that lies farthest along a direction.
Vec3 farthest_corner(const Box& box, const Vec3& direction) {
  return {direction.x >= 0 ? box.upper.x : box.lower.x,
          direction.y >= 0 ? box.upper.y : box.lower.y,
          direction.z >= 0 ? box.upper.z : box.lower.z};
}

}  // namespace

Frustum frustum_of(const Camera& camera) {
  const Vec3 forward = view_direction(camera);
  const Vec3 right = glm::normalize(glm::cross(forward, camera.up));
  const Vec3 up = glm::cross(right, forward);
  const float tangent_y = static_cast<float>(half_angle_tangent(camera.fovy_degrees));
  const float tangent_x = tangent_y * camera.aspect();

  Frustum frustum;
  frustum.planes[Frustum::kLeft] = through(camera.eye, right + tangent_x * forward);
  frustum.planes[Frustum::kRight] = through(camera.eye, tangent_x * forward - right);
  frustum.planes[Frustum::kBottom] = through(camera.eye, up + tangent_y * forward);
  frustum.planes[Frustum::kTop] = through(camera.eye, tangent_y * forward - up);
  frustum.planes[Frustum::kNear] = through(camera.eye + camera.near_distance * forward, forward);
  frustum.planes[Frustum::kFar] = through(camera.eye + camera.far_distance * forward, -forward);
  return frustum;
}

bool contains(const Frustum& frustum, const Vec3& point) {
  for (const Plane& plane : frustum.planes)
    if (plane.signed_distance(point) < 0) return false;
  return true;
}

Containment classify(const Frustum& frustum, const Sphere& sphere) {
  if (sphere.empty()) return Containment::kOutside;
  Containment result = Containment::kInside;
  for (const Plane& plane : frustum.planes) {
    const float distance = plane.signed_distance(sphere.center);
    if (distance < -sphere.radius) return Containment::kOutside;
    if (distance < sphere.radius) result = Containment::kIntersects;
  }
  return result;
}

Containment classify(const Frustum& frustum, const Box& box) {
  if (box.empty()) return Containment::kOutside;
  Containment result = Containment::kInside;
  for (const Plane& plane : frustum.planes) {
    if (plane.signed_distance(farthest_corner(box, plane.normal)) < 0) return Containment::kOutside;
    if (plane.signed_distance(farthest_corner(box, -plane.normal)) < 0)
      result = Containment::kIntersects;
  }
  return result;
}

}  // namespace varifold
