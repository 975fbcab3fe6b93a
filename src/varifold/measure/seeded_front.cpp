#include <varifold/measure/seeded_front.h>

#include <varifold/base/random.h>
#include <varifold/measure/closest_point.h>
#include <varifold/view/camera.h>
#include <algorithm>
#include <cmath>

namespace varifold::check {

namespace {

class Maker {
 public:
  Maker(const TriangleMesh& full, std::uint32_t base, std::uint32_t number)
      : full_(full), base_(base), random_(number) {
    for (const Vec3& p : full.positions) box_.add(p);
  }

  [[nodiscard]] Plane plane_around_all() const {
    const Vec3 normal(0, 0, 1);
    return {normal, -(box_.lower.z - box_.diagonal())};
  }
  Sphere sphere() { return {place(), box_.diagonal() * between(0.002, 0.5)}; }
  Plane plane() {
    const Vec3 normal = direction();
    return {normal, -glm::dot(normal, place())};
  }
  void look(SeededFront& front, bool with_light) {
    Camera camera;
    camera.target = place();
    camera.eye = camera.target + box_.diagonal() * between(0.05, 3) * direction();
    camera.up = direction();
    camera.fovy_degrees = between(10, 90);
    set_depth_range(camera, sphere_around(box_));
    front.options.tolerance = between(0.25, 32);
    if (!is_usable(camera)) return;
    ViewCriterion& view = front.criteria.view.emplace(camera);
    view.silhouette_weight = between(1, 8);
    if (random_.below(2) == 0) view.outside_weight = between(0.01, 1);
    if (random_.below(2) == 0) view.back_weight = between(0.01, 1);
    if (with_light) view.light = LightCriterion{.to_light = direction()};
  }
  // Few triangles are more of a trial than many.
  std::uint32_t budget() {
    const std::uint32_t full = full_.triangle_count();
    const double share = between(0.01, 1);
    return base_ + static_cast<std::uint32_t>(share * (full > base_ ? full - base_ : 0));
  }

 private:
  // Small numbers as likely as large ones.
  float between(double low, double high) {
    return static_cast<float>(low * std::pow(high / low, random_.uniform()));
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 d(static_cast<float>(2 * random_.uniform() - 1),
                   static_cast<float>(2 * random_.uniform() - 1),
                   static_cast<float>(2 * random_.uniform() - 1));
      if (glm::length(d) > 0.1f && glm::length(d) <= 1) return glm::normalize(d);
    }
  }
  // On the surface, or near it.
  Vec3 place() {
    const Vec3 corner = full_.positions[random_.below(full_.vertex_count())];
    return random_.below(2) == 0 ? corner
                                 : corner + box_.diagonal() * between(0.001, 0.2) * direction();
  }

  const TriangleMesh& full_;
  std::uint32_t base_;
  Random random_;
  Box box_;
};

}  // namespace

bool SeededFront::asks_for(const std::array<Vec3, 3>& triangle, float margin) const {
  if (options.max_triangles != kNone) return false;
  if (criteria.plane)
    for (const Vec3& corner : triangle)
      if (criteria.plane->signed_distance(corner) >= margin) return true;
  if (!criteria.sphere) return false;
  const DVec3 center(criteria.sphere->center);
  const DVec3 nearest =
      closest_on_triangle(center, DVec3(triangle[0]), DVec3(triangle[1]), DVec3(triangle[2]));
  return glm::length(center - nearest) <= double{criteria.sphere->radius} - margin;
}

SeededFront seeded_front(const TriangleMesh& full, std::uint32_t base, std::uint32_t number) {
  Maker maker(full, base, number);
  SeededFront front;
  if (number < 3) {
    front.name = number == 1 ? "base" : "full";
    if (number != 1) front.criteria.plane = maker.plane_around_all();
    return front;
  }
  switch (number % 6) {
    case 0:
      front.name = "sphere";
      front.criteria.sphere = maker.sphere();
      break;
    case 1:
      front.name = "plane";
      front.criteria.plane = maker.plane();
      break;
    case 2:
      front.name = "view";
      maker.look(front, false);
      break;
    case 3:
      front.name = "view, budget";
      maker.look(front, false);
      front.options.max_triangles = maker.budget();
      break;
    case 4:
      front.name = "sphere, plane, budget";
      front.criteria.sphere = maker.sphere();
      front.criteria.plane = maker.plane();
      front.options.max_triangles = maker.budget();
      break;
    default:
      front.name = "view, light, sphere";
      maker.look(front, true);
      front.criteria.sphere = maker.sphere();
      break;
  }
  return front;
}

}  // namespace varifold::check
