#include <varifold/view/camera_path.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace varifold {
namespace {

bool is_finite(const DVec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double length_of(const DVec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

/// What is interpolated: the numbers of a key, or their change per frame.
struct Pose {
  DVec3 eye, target, up;
  double fovy = 0;
};

template <class Combine>
Pose combined(const Pose& a, const Pose& b, const Combine& combine) {
  Pose result;
  for (int i = 0; i < 3; ++i) {
    result.eye[i] = combine(a.eye[i], b.eye[i]);
    result.target[i] = combine(a.target[i], b.target[i]);
    result.up[i] = combine(a.up[i], b.up[i]);
  }
  result.fovy = combine(a.fovy, b.fovy);
  return result;
}

/// A key with its frame, which lies before 0 or after the last where a closed path goes on.
struct Stop {
  double frame = 0;
  Pose pose;
};

Stop stop_at(const CameraPath& path, std::ptrdiff_t index) {
  const auto count = static_cast<std::ptrdiff_t>(path.keys.size());
  double shift = 0;
  if (path.is_closed) {
    if (index < 0) index += count, shift = -1;
    if (index >= count) index -= count, shift = 1;
  }
  index = std::clamp<std::ptrdiff_t>(index, 0, count - 1);
  const CameraKey& key = path.keys[static_cast<std::size_t>(index)];
  return {key.frame + shift * path.frames, {key.eye, key.target, key.up, key.fovy_degrees}};
}

/// The change per frame between two stops; none where they are one.
Pose slope(const Stop& a, const Stop& b) {
  const double frames = b.frame - a.frame;
  if (!(frames > 0)) return {};
  return combined(a.pose, b.pose, [&](double x, double y) { return (y - x) / frames; });
}

Pose pose_at(const CameraPath& path, std::uint32_t frame) {
  const auto next =
      std::upper_bound(path.keys.begin(), path.keys.end(), frame,
                       [](std::uint32_t f, const CameraKey& key) { return f < key.frame; });
  const std::ptrdiff_t index = next - path.keys.begin() - 1;
  const Stop a = stop_at(path, index);
  const Stop b = stop_at(path, index + 1);
  const double span = b.frame - a.frame;
  if (!(span > 0) || a.frame == frame) return a.pose;
  const double t = (frame - a.frame) / span;
  if (path.interpolation == CameraPath::Interpolation::kLinear)
    return combined(a.pose, b.pose, [&](double x, double y) { return x + (y - x) * t; });

  const Pose from = slope(stop_at(path, index - 1), b);
  const Pose to = slope(a, stop_at(path, index + 2));
  const double r = 1 - t;
  const Pose places = combined(a.pose, b.pose, [&](double x, double y) {
    return x * (r * r * (1 + 2 * t)) + y * (t * t * (1 + 2 * r));
  });
  const Pose bends = combined(
      from, to, [&](double x, double y) { return span * (x * (t * r * r) - y * (t * t * r)); });
  return combined(places, bends, [](double x, double y) { return x + y; });
}

tl::unexpected<Error> bad_frame(std::uint32_t frame, const std::string& fault) {
  return fail(ErrorKind::kInvalidInput, "frame " + std::to_string(frame) + ": " + fault);
}

/// From the units of a path to those of the model.
Result<void> place_in(const Box& bounds, Pose& pose, std::uint32_t frame) {
  const DVec3 lower(bounds.lower), upper(bounds.upper);
  const double diagonal = bounds.empty() ? 0 : length_of(upper - lower);
  if (!(diagonal > 0) || !std::isfinite(diagonal))
    return bad_frame(frame, "the path is in diagonals of the mesh, which has no extent");
  const DVec3 center = 0.5 * (lower + upper);
  pose.eye = center + diagonal * pose.eye;
  pose.target = center + diagonal * pose.target;
  return {};
}

/// Why a camera cannot see; nothing where it can.
const char* fault_of(const Camera& camera) {
  const auto finite = [](const Vec3& v) { return is_finite(DVec3(v)); };
  if (!finite(camera.eye) || !finite(camera.target) || !finite(camera.up))
    return "a coordinate is too large";
  if (!(camera.fovy_degrees > 0 && camera.fovy_degrees < 180))
    return "the angle of view is not between 0 and 180 degrees";
  if (!(glm::length(camera.target - camera.eye) > 0)) return "eye and target are one point";
  const Vec3 direction = normalize_or_zero(camera.target - camera.eye);
  const Vec3 up = normalize_or_zero(camera.up);
  if (!(glm::length(glm::cross(direction, up)) > 1e-6f)) return "up is along the line of sight";
  return is_usable(camera) ? nullptr : "the camera cannot see";
}

}  // namespace

Result<void> check_camera_path(const CameraPath& path) {
  const auto bad = [](std::string fault) {
    return fail(ErrorKind::kInvalidInput, std::move(fault));
  };
  if (path.frames == 0 || path.frames > kMaxPathFrames)
    return bad("frames: " + std::to_string(path.frames) + ", not between 1 and " +
               std::to_string(kMaxPathFrames));
  for (const int side : {path.width, path.height})
    if (side < 1 || side > kMaxPathSize)
      return bad("size: a side is not between 1 and " + std::to_string(kMaxPathSize));
  if (path.keys.empty()) return bad("keys: there are none");
  for (std::size_t i = 0; i < path.keys.size(); ++i) {
    const CameraKey& key = path.keys[i];
    const std::string place = "keys[" + std::to_string(i) + "]";
    if (i == 0 && key.frame != 0) return bad(place + ": the first key is not that of frame 0");
    if (i > 0 && key.frame <= path.keys[i - 1].frame)
      return bad(place + ": frame " + std::to_string(key.frame) + " does not come after frame " +
                 std::to_string(path.keys[i - 1].frame));
    if (key.frame >= path.frames)
      return bad(place + ": frame " + std::to_string(key.frame) + " of " +
                 std::to_string(path.frames));
    if (!is_finite(key.eye) || !is_finite(key.target) || !is_finite(key.up) ||
        !std::isfinite(key.fovy_degrees))
      return bad(place + ": a number is not finite (frame " + std::to_string(key.frame) + ")");
  }
  return {};
}

Result<Camera> camera_at(const CameraPath& path, std::uint32_t frame, const Box& bounds) {
  assert(frame < path.frames && !path.keys.empty());
  Pose pose = pose_at(path, frame);
  if (path.units == CameraPath::Units::kDiagonals)
    if (auto placed = place_in(bounds, pose, frame); !placed) return tl::unexpected(placed.error());
  Camera camera;
  camera.eye = Vec3(pose.eye);
  camera.target = Vec3(pose.target);
  const double up = length_of(pose.up);
  camera.up = Vec3(up > 0 ? pose.up / up : pose.up);
  camera.fovy_degrees = static_cast<float>(pose.fovy);
  camera.width = path.width;
  camera.height = path.height;
  if (camera.eye != camera.target) set_depth_range(camera, sphere_around(bounds));
  if (const char* const fault = fault_of(camera)) return bad_frame(frame, fault);
  return camera;
}

Result<std::vector<Camera>> cameras_of(const CameraPath& path, const Box& bounds) {
  std::vector<Camera> cameras;
  cameras.reserve(path.frames);
  for (std::uint32_t frame = 0; frame < path.frames; ++frame) {
    auto camera = camera_at(path, frame, bounds);
    if (!camera) return tl::unexpected(std::move(camera.error()));
    cameras.push_back(*camera);
  }
  return cameras;
}

}  // namespace varifold
