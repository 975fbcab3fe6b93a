// Random views of a mesh, and what they see of it.
#pragma once

#include <embree3/rtcore.h>
#include <varifold/base/random.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/normals.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/camera.h>
#include <varifold/view/criteria.h>
#include <cstdint>
#include <vector>

namespace varifold::bench {

/// Points on a surface, by area.
class Sampler {
 public:
  explicit Sampler(const TriangleMesh& mesh) : mesh_(mesh) {
    double sum = 0;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      until_.push_back(sum += triangle_area(mesh, t));
  }
  struct Sample {
    DVec3 point;
    Vec3 normal;
  };
  Sample next(Random& random) const {
    const double at = random.uniform() * until_.back();
    const auto found = std::upper_bound(until_.begin(), until_.end() - 1, at);
    const auto t = static_cast<std::uint32_t>(found - until_.begin());
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const std::uint32_t* const c = &mesh_.indices[3 * std::size_t{t}];
    const DVec3 a(mesh_.positions[c[0]]), b(mesh_.positions[c[1]]), d(mesh_.positions[c[2]]);
    return {a + u * (b - a) + v * (d - a), face_normal(mesh_, t)};
  }

 private:
  const TriangleMesh& mesh_;
  std::vector<double> until_;
};

// Whether a surface hides its points from an eye.
class Occluder {
 public:
  explicit Occluder(const TriangleMesh& mesh)
      : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const points = static_cast<Vec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(Vec3), mesh.positions.size()));
    std::copy(mesh.positions.begin(), mesh.positions.end(), points);
    auto* const corners = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.indices.size() / 3));
    std::copy(mesh.indices.begin(), mesh.indices.end(), corners);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene_);
  }
  ~Occluder() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Occluder(const Occluder&) = delete;
  Occluder& operator=(const Occluder&) = delete;

  // What is nearer to the point than `margin` hides nothing.
  [[nodiscard]] bool hides(const Vec3& point, const Vec3& eye, float margin) const {
    const Vec3 way = eye - point;
    const float distance = glm::length(way);
    RTCRay ray{};
    ray.org_x = point.x, ray.org_y = point.y, ray.org_z = point.z;
    ray.dir_x = way.x / distance, ray.dir_y = way.y / distance, ray.dir_z = way.z / distance;
    ray.tnear = margin;
    ray.tfar = distance;
    ray.mask = 0xffffffff;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_, &context, &ray);
    return ray.tfar < 0;
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

inline Vec3 random_direction(Random& random) {
  const auto z = static_cast<float>(2 * random.uniform() - 1);
  const auto turn = static_cast<float>(6.283185307179586 * random.uniform());
  const float side = std::sqrt(1 - z * z);
  return {side * std::cos(turn), side * std::sin(turn), z};
}

// Looks at a point of the surface from its outer side, 0.3 to 4 diagonals away; 1920 x 1080.
inline Camera random_view(const Sampler& surface, const Box& box, Random& random) {
  Camera camera;
  do {
    const Sampler::Sample seen = surface.next(random);
    Vec3 side = random_direction(random);
    if (glm::dot(side, seen.normal) < 0) side = -side;
    const auto distance = static_cast<float>(0.3 * std::pow(4 / 0.3, random.uniform()));
    camera.target = Vec3(seen.point);
    camera.eye = camera.target + distance * box.diagonal() * side;
    camera.up = random_direction(random);
    camera.width = 1920;
    camera.height = 1080;
    set_depth_range(camera, sphere_around(box));
  } while (!is_usable(camera));
  return camera;
}

struct Original {
  const TriangleMesh& mesh;
  Box box = bounds(mesh);
  Sampler sampler{mesh};
  Occluder occluder{mesh};
  SurfaceDistance surface{mesh};

  // In the frustum, turned to the eye and not hidden.
  [[nodiscard]] bool shows(const Sampler::Sample& sample, const ViewCriterion& view) const {
    const Vec3 point(sample.point);
    if (glm::dot(sample.normal, view.eye - point) <= 0) return false;
    for (const Plane& plane : view.frustum.planes)
      if (plane.signed_distance(point) < 0) return false;
    return !occluder.hides(point, view.eye, 1e-5f * box.diagonal());
  }
};

}  // namespace varifold::bench
